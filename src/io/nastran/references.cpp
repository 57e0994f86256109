// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Fields of cards: MSC Nastran Quick Reference Guide, "Bulk Data Entries".
#include "io/nastran/references.hpp"

#include "base/text.hpp"
#include "io/deck/numbers.hpp"
#include "io/stream/read_limits.hpp"

#include <algorithm>
#include <map>
#include <unordered_set>

namespace meshorder::nastran {
namespace {

/// Cards with the same fields. `fields` has one letter for each field after the name: a node (n), a node if
/// the next field is blank (G), an element (e), the number of an element that is not a cell (x), other (-).
/// Letters in parentheses repeat to the end of the card. N, E and S begin a list: of nodes, of elements, of
/// points that are not nodes. From a "." on, all fields must be blank: some programs give a second element
/// there.
struct CardPattern {
  std::string_view fields;
  std::vector<std::string_view> names;
};

using FieldsOfCards = std::map<std::string_view, std::string_view>;

FieldsOfCards by_name(const std::vector<CardPattern>& patterns) {
  FieldsOfCards result;
  for (const auto& [fields, names] : patterns) {
    for (const std::string_view name : names) result.emplace(name, fields);
  }
  return result;
}

const FieldsOfCards kFieldsOfCards = by_name({
    {"--------N", {"ACCEL1"}},
    {"-n--n", {"DAREA", "DELAY", "DPHASE", "SPC", "SPCD"}},
    {"-n", {"DVGRID", "FORCE", "MOMENT", "RFORCE", "TIC"}},
    {"-n-nn", {"FORCE1", "MOMENT1"}},
    {"-n-nnnn", {"FORCE2", "MOMENT2"}},
    {"--nnnn", {"PLOAD"}},
    {"-e", {"PLOAD1"}},
    {"-e--nn", {"PLOADX1"}},
    {"--E", {"PLOAD2", "QBDY1"}},
    {"--nE", {"QBDY3", "QVOL"}},
    {"----nnnnnnnn", {"QHBDY"}},
    {"-(n-)", {"SLOAD", "SUPORT1", "USET"}},
    {"-n-n-n", {"TEMP"}},
    {"-e------E", {"TEMPP1"}},
    {"-e--------------E", {"TEMPRB"}},
    {"(n-)", {"ASET", "BSET", "CSET", "OMIT", "QSET", "SEQGP", "SUPORT"}},
    {"-N", {"ASET1", "BLSEG", "BNDGRID", "BSET1", "CSET1", "OMIT1", "QSET1"}},
    {"(-n--n---)", {"MPC"}},
    {"--N", {"SPC1", "USET1"}},
    {"xnn", {"RBAR", "RBAR1", "RJOINT", "RROD"}},
    {"(xn-n-n--)", {"RBE1"}},
    {"xn-N", {"RBE2"}},
    {"x-n(n-)", {"RSPLINE"}},
    {"xnnn", {"RTRPLT"}},
    {"x-nnG", {"CBUSH", "CGAP"}},
    {"x-nn", {"CBUSH1D"}},
    {"x-n-n", {"CDAMP1", "CDAMP2", "CELAS1", "CELAS2", "CMASS1", "CMASS2"}},
    {"x-nn.", {"CDAMP3", "CDAMP4", "CDAMP5", "CELAS3", "CELAS4", "CMASS3", "CMASS4", "CVISC"}},
    {"xe", {"CHBDYE"}},
    {"x-------nnnnnnnn", {"CHBDYG"}},
    {"xn", {"CONM1", "CONM2"}},
    {"--nnnnnnnnnn", {"CONV"}},
    {"xnn.", {"PLOTEL"}},
    {"----G", {"BAROR", "BEAMOR"}},
    {"-E", {"BSURF"}},
    {"-nnn-nnn", {"CORD1C", "CORD1R", "CORD1S"}},
    {"---------n", {"EIGB", "EIGR", "PCONV"}},
    {"---n", {"EIGC"}},
    {"S", {"EPOINT", "SPOINT"}},
    {"n-nE", {"RADBC"}},
    // clang-format off
    {"", {  // cards that name neither nodes nor elements
    "ACCEL", "BCPROP", "BCTADD", "BCTPARM", "BFRIC", "CORD2C", "CORD2R", "CORD2S", "CREEP",
    "DAMPING", "DCONADD", "DCONSTR", "DEQATN", "DESVAR", "DLINK", "DLOAD", "DOPTPRM", "DTABLE", "DVMREL1",
    "DVPREL1", "ECHOOFF", "ECHOON", "EIGP", "EIGRL", "FREQ", "FREQ1", "FREQ2", "FREQ3", "FREQ4",
    "FREQ5", "GRAV", "GRDSET", "LOAD", "LSEQ", "MAT1", "MAT10", "MAT2", "MAT3", "MAT4",
    "MAT5", "MAT8", "MAT9", "MATEP", "MATG", "MATHE", "MATHP", "MATORT", "MATS1", "MATT1",
    "MATT2", "MATT3", "MATT4", "MATT5", "MATT8", "MATT9", "MDLPRM", "MPCADD", "NLPARM", "NLPCI",
    "NSMADD", "PBAR", "PBARL", "PBCOMP", "PBEAM", "PBEAML", "PBEND", "PBUSH", "PBUSH1D", "PBUSHT",
    "PCOMP", "PCOMPG", "PCOMPP", "PDAMP", "PDAMPT", "PELAS", "PELAST", "PFAST", "PGAP",
    "PHBDY", "PLCOMP", "PLPLANE", "PLSOLID", "PLY", "PMASS", "PROD", "PSHEAR", "PSHELL", "PSHLN1",
    "PSLDN1", "PSOLID", "PTUBE", "PVISC", "PWELD", "RADM", "RADMT", "RADSET", "RANDPS", "RANDT1",
    "RFORCEADD", "RLOAD1", "RLOAD2", "SPCADD", "STACK", "TABDMP1", "TABLED1", "TABLED2", "TABLED3",
    "TABLED4", "TABLEM1", "TABLEM2", "TABLEM3", "TABLEM4", "TABLES1", "TABLEST", "TABRND1", "TABRNDG",
    "TEMPD", "TLOAD1", "TLOAD2", "TSTEP", "TSTEP1", "TSTEPNL", "VIEW", "VIEW3D",
    }},
    // clang-format on
});

constexpr Association association_of(char letter) {
  return letter == 'n' || letter == 'N' ? Association::vertices : Association::cells;
}

bool is_word(std::string_view field, std::string_view word) {
  return field.size() == word.size() && same_but_for_case(field, word);
}

/// Collects the nodes and elements that a card names.
class Finder {
 public:
  explicit Finder(const CardFields& card) : card_(card) {}

  std::optional<References> by_layout(std::string_view layout) {
    const std::size_t open = layout.find('(');
    const std::string_view begin = layout.substr(0, open);
    const std::string_view repeated =
        open == std::string_view::npos ? "" : layout.substr(open + 1, layout.find(')') - open - 1);
    for (std::size_t field = 1; field < card_.fields.size(); ++field) {
      const std::size_t k = field - 1;
      if (k >= begin.size() && repeated.empty()) break;
      const char letter = k < begin.size() ? begin[k] : repeated[(k - begin.size()) % repeated.size()];
      if (letter == '.') return ends_at(field) ? std::optional(found_) : std::nullopt;
      if (letter == 'N' || letter == 'E' || letter == 'S') return with_list(letter, field);
      add(letter, field);
    }
    return found_;
  }

  /// Finds the points of RBE3: after each weight and its components, and after UM.
  std::optional<References> of_rbe3() {
    found_.defines_element = true;
    add('n', 3);
    bool in_dependent = false;  // after UM: pairs of points and components
    int since = 0;              // fields since the last weight or UM
    for (std::size_t field = 5; field < card_.fields.size(); ++field) {
      const std::string_view text = card_.text(field);
      if (text.empty()) continue;
      if (is_word(text, "ALPHA")) break;
      if (is_word(text, "UM")) {
        in_dependent = true;
        since = 0;
        continue;
      }
      const bool is_real = text.find('.') != std::string_view::npos;
      if (is_real && !in_dependent) {
        since = 0;
        continue;
      }
      // components follow a weight, a point follows UM
      const bool is_point = in_dependent ? since % 2 == 0 : since > 0;
      ++since;
      if (!is_point) continue;
      if (number_of(text) == 0) return {};
      add('n', field);
    }
    return found_;
  }

  /// Finds the points of DMIG (a matrix by columns, each of a point); its first card names none.
  std::optional<References> of_dmig() { return card_.text(2) == "0" ? found_ : by_layout("-n--(n---)"); }

  /// PLOAD4, a pressure on solids or shells, names one element and two nodes, or a range of elements.
  std::optional<References> of_pload4() {
    if (is_word(card_.text(7), "THRU")) {
      found_.list = 2;
      found_.of_list = Association::cells;
      found_.is_range = true;
      return found_;
    }
    return by_layout("-e----nn");
  }

  std::optional<References> of_param() { return is_word(card_.text(1), "GRDPNT") ? by_layout("-n") : found_; }

  /// SET3 is a set of grid points or elements. Sets of properties name neither; other sets are not known.
  std::optional<References> of_set3() {
    const std::string_view kind = card_.text(2);
    if (is_word(kind, "GRID") || is_word(kind, "POINT")) return by_layout("--N");
    if (is_word(kind, "ELEM")) return by_layout("--E");
    return is_word(kind, "PROP") ? std::optional(found_) : std::nullopt;
  }

 private:
  /// Returns whether all fields of the card from this one on are blank.
  [[nodiscard]] bool ends_at(std::size_t field) const {
    while (field < card_.fields.size() && card_.text(field).empty()) ++field;
    return field >= card_.fields.size();
  }

  void add(char letter, std::size_t field) {
    if (letter == 'x' && field == 1) found_.defines_element = true;
    if (letter == 'G') letter = card_.text(field + 1).empty() ? 'n' : '-';
    if (letter != 'n' && letter != 'e') return;
    if (number_of(card_.text(field)) > 0) found_.fields.push_back({association_of(letter), field});
  }

  std::optional<References> with_list(char letter, std::size_t field) {
    found_.list = field;
    found_.of_list = association_of(letter);
    if (letter == 'S') found_.defines_points = true;
    for (std::size_t k = field; k < card_.fields.size(); ++k) {
      if (is_word(card_.text(k), "THRU")) found_.is_range = true;
      if (is_word(card_.text(k), "EXCEPT")) return {};
    }
    if (found_.is_range && !ranges_of(card_, field)) return {};
    return found_;
  }

  const CardFields& card_;
  References found_;
};

}  // namespace

std::optional<References> references(std::string_view name, const CardFields& card) {
  if (!card.fault.empty()) return {};
  Finder finder(card);
  if (name == "PLOAD4") return finder.of_pload4();
  if (name == "RBE3") return finder.of_rbe3();
  if (name == "DMIG") return finder.of_dmig();
  if (name == "PARAM") return finder.of_param();
  if (name == "SET3") return finder.of_set3();
  const auto fields = kFieldsOfCards.find(name);
  if (fields == kFieldsOfCards.end()) return {};
  const auto found = finder.by_layout(fields->second);
  const bool is_path = name == "BLSEG" && found && found->is_range;  // the order of the nodes matters
  return is_path ? std::nullopt : found;
}

std::optional<std::vector<NumberRange>> ranges_of(const CardFields& card, std::size_t list) {
  std::vector<NumberRange> ranges;
  for (std::size_t k = list; k < card.fields.size(); ++k) {
    const std::string_view text = card.text(k);
    if (text.empty()) continue;
    if (is_word(text, "THRU") || is_word(text, "BY")) {
      std::size_t next = k + 1;
      while (next < card.fields.size() && card.text(next).empty()) ++next;  // may be on the next line
      const std::int64_t number = number_of(card.text(next));
      if (ranges.empty() || number == 0) return {};
      (is_word(text, "BY") ? ranges.back().step : ranges.back().to) = number;
      k = next;
      continue;
    }
    const std::int64_t number = number_of(text);
    if (number == 0) return {};
    ranges.push_back({number, number, 1});
  }
  return ranges;
}

std::vector<std::int64_t> numbers_in_list(const std::vector<NumberRange>& ranges, const IdMap& items,
                                          const std::vector<std::int64_t>& others,
                                          std::vector<Index>& found) {
  std::vector<std::int64_t> numbers;
  std::unordered_set<Index> seen;
  const bool may_repeat = ranges.size() > 1;
  for (const auto& [from, to, step] : ranges) {
    const std::vector<Index> in_range = items_in_range(items, from, to, step);
    if (may_repeat) claim_memory(in_range.size() * 8 * sizeof(Index), "a list of numbers");
    for (const Index item : in_range) {
      if (!may_repeat || seen.insert(item).second) found.push_back(item);
    }
    for (auto at = std::lower_bound(others.begin(), others.end(), from); at != others.end() && *at <= to;
         ++at) {
      if ((*at - from) % step == 0) numbers.push_back(*at);
    }
  }
  return numbers;
}

}  // namespace meshorder::nastran
