// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Keywords and their data lines: Abaqus Keywords Reference Guide; G. Dhondt, CalculiX CrunchiX User's Manual,
// "Input deck format".
#include "io/abaqus/cards.hpp"

#include "base/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <system_error>
#include <utility>

namespace meshorder::abaqus {
namespace {

constexpr std::string_view kEnds = "\r\n";
constexpr std::string_view kBlanksAndEnds = " \t\f\v\r\n";

/// Returns the bytes of the line at the front, with its end.
std::string_view first_line(std::string_view text) {
  const std::size_t end = text.find_first_of(kEnds);
  if (end == std::string_view::npos) return text;
  return text.substr(0, end + (text.substr(end, 2) == "\r\n" ? 2 : 1));
}

std::string_view without_end(std::string_view line) { return line.substr(0, line.find_first_of(kEnds)); }

bool is_comment_line(std::string_view line) { return trimmed(line).starts_with("**"); }

/// Returns the length in bytes of the comments and blank lines at the front.
std::size_t skipped_lines(std::string_view lines) {
  std::size_t length = 0;
  while (length < lines.size()) {
    const std::string_view line = first_line(lines.substr(length));
    if (!is_comment_line(line) && !trimmed(without_end(line)).empty()) break;
    length += line.size();
  }
  return length;
}

/// Returns the parts of a keyword line between commas; commas in quotes do not count. Comments belong to no
/// part.
std::vector<std::string_view> pieces_of(std::string_view lines) {
  std::vector<std::string_view> pieces;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0 && kEnds.find(lines[i - 1]) != std::string_view::npos &&
        is_comment_line(first_line(lines.substr(i)))) {
      begin = i + skipped_lines(lines.substr(i));
      i = begin - 1;
      continue;
    }
    if (lines[i] == '"') quoted = !quoted;
    if (lines[i] != ',' || quoted) continue;
    pieces.push_back(lines.substr(begin, i - begin));
    begin = i + 1;
  }
  pieces.push_back(lines.substr(begin));
  return pieces;
}

/// Returns `text` in capitals and without blanks. CalculiX ignores blanks in keywords.
std::string compact(std::string_view text) {
  std::string result = upper_case(text);
  std::erase_if(result, [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; });
  return result;
}

std::string_view trimmed_of_ends(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanksAndEnds);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanksAndEnds) - first + 1);
}

/// Returns whether `line`, which follows a keyword line with a comma at its end, has further parameters. Such
/// a line begins with a parameter that has a value, or with a parameter without value that changes the data
/// lines. All other lines are data (numbers, names of sets): CalculiX, unlike Abaqus, does not continue
/// keyword lines.
bool continues_keyword(std::string_view line) {
  constexpr std::array<std::string_view, 6> kWithoutValue{"GENERATE", "INTERNAL", "REMOVE",
                                                          "RIKS",     "TABULAR",  "UNSORTED"};
  line = trimmed(line);
  const std::string_view first = trimmed(line.substr(0, line.find_first_of(",=")));
  if (first.empty() || std::isalpha(static_cast<unsigned char>(first.front())) == 0) return false;
  return line.find('=') != std::string_view::npos ||
         std::find(kWithoutValue.begin(), kWithoutValue.end(), upper_case(first)) != kWithoutValue.end();
}

Card::Parameter parameter_of(std::string_view piece) {
  const std::size_t equals = piece.find('=');
  Card::Parameter result{compact(piece.substr(0, equals)), {}};
  if (equals != std::string_view::npos) {
    result.value = without_quotes(trimmed_of_ends(piece.substr(equals + 1)));
  }
  return result;
}

}  // namespace

const Card::Parameter* Card::find(std::string_view name) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const Parameter& parameter) { return parameter.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

std::string_view Card::value(std::string_view name) const {
  const Parameter* const parameter = find(name);
  return parameter == nullptr ? std::string_view() : parameter->value;
}

std::string_view keyword_lines(std::string_view lines) {
  std::string_view line = first_line(lines);
  std::size_t length = line.size();
  while (trimmed(without_end(line)).ends_with(',')) {
    const std::size_t next = length + skipped_lines(lines.substr(length));
    line = first_line(lines.substr(next));
    if (!continues_keyword(without_end(line))) break;
    length = next + line.size();
  }
  return lines.substr(0, length);
}

Card parse_card(std::string_view lines) {
  lines = keyword_lines(lines);
  const std::vector<std::string_view> pieces = pieces_of(lines);
  Card card;
  const std::string_view keyword = trimmed_of_ends(pieces.front());
  card.title = upper_case(keyword);
  card.keyword = compact(keyword.substr(keyword.starts_with('*') ? 1 : 0));
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    Card::Parameter parameter = parameter_of(pieces[i]);
    if (!parameter.name.empty()) card.parameters.push_back(std::move(parameter));
  }
  return card;
}

std::string without_parameter(std::string_view lines, std::string_view name) {
  const std::string_view keyword = keyword_lines(lines);
  const std::vector<std::string_view> pieces = pieces_of(keyword);
  std::string result(pieces.front());
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    if (parameter_of(pieces[i]).name != name) {
      result.append(",").append(pieces[i]);
    } else if (i + 1 == pieces.size()) {  // the end of the last line stays
      result += pieces[i].substr(pieces[i].find_last_not_of(kBlanksAndEnds) + 1);
    }
  }
  return result.append(lines.substr(keyword.size()));
}

std::string_view next_field(std::string_view& line) {
  const std::size_t comma = line.find(',');
  const std::string_view field = trimmed(line.substr(0, comma));
  line = comma == std::string_view::npos ? std::string_view() : line.substr(comma + 1);
  return field;
}

std::string_view without_quotes(std::string_view value) {
  const bool quoted = value.size() >= 2 && value.front() == '"' && value.back() == '"';
  return quoted ? value.substr(1, value.size() - 2) : value;
}

std::int64_t number_of(std::string_view field) {
  if (const std::size_t dot = field.rfind('.');
      dot != std::string_view::npos && dot > 0 &&
      std::isdigit(static_cast<unsigned char>(field.front())) == 0) {
    field.remove_prefix(dot + 1);
  }
  std::int64_t number = 0;
  const char* const end = field.data() + field.size();
  const auto [after, code] = std::from_chars(field.data(), end, number);
  return code == std::errc{} && after == end && number > 0 ? number : 0;
}

namespace {

/// Keywords with the same fields in their data lines: nodes (n), elements (e) or neither (-). A final +
/// repeats the last letter for all further fields.
struct LineFields {
  std::string_view fields;
  std::vector<std::string_view> keywords;
};

const std::vector<LineFields> kLayouts{
    {"n",
     {"BOUNDARY", "CFLUX", "CLOAD", "DISTRIBUTINGCOUPLING", "KINEMATICCOUPLING", "NODALTHICKNESS",
      "RETAINEDNODALDOFS", "TEMPERATURE"}},
    {"e", {"BOUNDARYF", "DFLUX", "DLOAD", "FILM", "MASSFLOW", "RADIATE", "RELEASE"}},
    {"", {"DSFLUX", "DSLOAD"}},
    {"e+", {"ELSET", "MODELCHANGE"}},
    {"-n+", {"MPC"}},
    {"en", {"NORMAL"}},
    {"n+", {"NSET", "SUBMODEL"}},
};

/// Keywords whose lines name neither nodes nor elements by number.
constexpr std::array<std::string_view, 115> kPlain{
    // clang-format off
    "AMPLITUDE", "ASSEMBLY", "BEAMGENERALSECTION", "BEAMSECTION", "BUCKLE", "CHANGEFRICTION",
    "CHANGEMATERIAL", "CHANGEPLASTIC", "CLEARANCE", "COHESIVESECTION", "COMPLEXFREQUENCY", "CONDUCTIVITY",
    "CONSTRAINT", "CONTACT", "CONTACTCONTROLS", "CONTACTDAMPING", "CONTACTFILE", "CONTACTINCLUSIONS",
    "CONTACTOUTPUT", "CONTACTPAIR", "CONTACTPRINT", "CONTACTPROPERTYASSIGNMENT", "CONTROLS",
    "COUPLEDTEMPERATURE-DISPLACEMENT", "COUPLING", "CREEP", "CYCLICHARDENING", "CYCLICSYMMETRYMODEL",
    "DAMAGEEVOLUTION", "DAMAGEINITIATION", "DAMPING", "DASHPOT", "DEFORMATIONPLASTICITY", "DENSITY", "DEPVAR",
    "DESIGNRESPONSE", "DISTRIBUTING", "DYNAMIC", "ELASTIC", "ELECTRICALCONDUCTIVITY", "ELEMENTOUTPUT",
    "ELFILE", "ELPRINT", "ENDASSEMBLY", "ENDINSTANCE", "ENDPART", "ENDSTEP", "ENERGYFILE", "ENERGYOUTPUT",
    "ENERGYPRINT", "EXPANSION", "FILEFORMAT", "FLUIDCONSTANTS", "FLUIDSECTION", "FREQUENCY", "FRICTION",
    "GAP", "GAPCONDUCTANCE", "GAPHEATGENERATION", "GREEN", "HEADING", "HEATTRANSFER", "HOURGLASSSTIFFNESS",
    "HYPERELASTIC", "HYPERFOAM", "INSTANCE", "KINEMATIC", "MAGNETICPERMEABILITY", "MASS", "MATERIAL",
    "MEMBRANESECTION", "MODALDAMPING", "MODALDYNAMIC", "MOHRCOULOMB", "NOANALYSIS", "NODEFILE", "NODEOUTPUT",
    "NODEPRINT", "OUTPUT", "PART", "PHYSICALCONSTANTS", "PLASTIC", "POTENTIAL", "PRE-TENSIONSECTION",
    "PREPRINT", "RANDOMRESPONSE", "RATEDEPENDENT", "RESTART", "RIGIDBODY", "ROTARYINERTIA", "SECTIONCONTROLS",
    "SECTIONPRINT", "SELECTCYCLICSYMMETRYMODES", "SENSITIVITY", "SHELLGENERALSECTION", "SHELLSECTION",
    "SOLIDSECTION", "SPECIFICGASCONSTANT", "SPECIFICHEAT", "SPRING", "STATIC", "STEADYSTATEDYNAMICS", "STEP",
    "SURFACEBEHAVIOR", "SURFACEINTERACTION", "TIE", "TIMEPOINTS", "TRANSFORM", "TRANSVERSESHEARSTIFFNESS",
    "UNCOUPLEDTEMPERATURE-DISPLACEMENT", "USERMATERIAL", "VALUESATINFINITY", "VIEWFACTOR", "VISCO",
    "VISCOELASTIC",
    // clang-format on
};

/// Returns the fields of a card that names nodes because of one of its parameters; nullopt for other cards.
std::optional<std::string_view> fields_with_parameter(const Card& card) {
  if (card.keyword == "CLEARANCE" && card.has("TABULAR")) return "n";
  if (card.keyword == "EQUATION" && card.has("REMOVE")) return "n";
  if (card.keyword == "STATIC" && card.has("RIKS")) return "-----n";  // node that may end the step
  return {};
}

/// Returns the fields of a card whose TYPE or DEFINITION decides them; nullopt for other cards.
std::optional<std::string_view> fields_by_parameters(const Card& card) {
  const std::string type = compact(card.value("TYPE"));
  if (card.keyword == "SURFACE") {
    if (type.empty() || type == "ELEMENT") return "e";
    if (type == "NODE") return "n";
  }
  if (card.keyword == "INITIALCONDITIONS") {
    constexpr std::array<std::string_view, 8> kOnNodes{"TEMPERATURE",   "VELOCITY",        "DISPLACEMENT",
                                                       "FLUIDVELOCITY", "PRESSURE",        "MASSFLOW",
                                                       "TOTALPRESSURE", "ROTATINGVELOCITY"};
    if (std::find(kOnNodes.begin(), kOnNodes.end(), type) != kOnNodes.end()) return "n";
    if (type == "STRESS" || type == "PLASTICSTRAIN") return "e";
  }
  if (card.keyword == "ORIENTATION") {
    const std::string_view definition = card.value("DEFINITION");
    if (definition.empty() || same_but_for_case(definition, "COORDINATES")) return "";
  }
  return {};
}

std::optional<std::string_view> fields_of(const Card& card) {
  const auto with_parameter = fields_with_parameter(card);
  const bool is_plain = std::find(kPlain.begin(), kPlain.end(), card.keyword) != kPlain.end();
  if (is_plain && !with_parameter) return "";
  if (has_other_file(card)) return {};
  if (with_parameter) return with_parameter;
  if (const auto fields = fields_by_parameters(card)) return fields;
  for (const auto& [fields, keywords] : kLayouts) {
    if (std::find(keywords.begin(), keywords.end(), card.keyword) != keywords.end()) return fields;
  }
  return {};
}

/// Returns the letter of a line's k-th field, see LineFields: n, e or -.
char field_at(std::string_view fields, std::size_t k) {
  const bool repeats = fields.ends_with('+');
  const std::size_t given = fields.size() - (repeats ? 1 : 0);
  if (k < given) return fields[k];
  return repeats ? fields[given - 1] : '-';
}

/// Calls `work` with each line below a keyword, without its end; leaves out comments.
template <class Work>
void for_data_lines(std::string_view lines, const Work& work) {
  for (std::size_t begin = keyword_lines(lines).size(); begin < lines.size();) {
    const std::string_view line = first_line(lines.substr(begin));
    if (!is_comment_line(line)) work(without_end(line));
    begin += line.size();
  }
}

/// Collects references from the lines below a keyword.
class ReferenceFinder {
 public:
  ReferenceFinder(const Card& card, std::string_view lines) : card_(card), lines_(lines) {}

  std::optional<std::vector<Reference>> find() {
    if (pairs_sets(card_, lines_)) return {};
    add_parameters(keyword_lines(lines_));
    // the numbers below *SECTION PRINT may be nodes on its axes
    if (card_.keyword == "SECTIONPRINT" && has_numbers_in_front()) return {};
    if (card_.keyword == "EQUATION" && !card_.has("REMOVE")) {
      if (has_other_file(card_)) return {};
      for_data_lines(lines_, [this](std::string_view line) { add_terms(line); });
      return std::move(found_);
    }
    const auto fields = fields_of(card_);
    if (!fields) return {};
    if (!fields->empty()) for_data_lines(lines_, [&](std::string_view line) { add_fields(line, *fields); });
    return std::move(found_);
  }

 private:
  /// Returns whether a line below the keyword begins with a whole number.
  [[nodiscard]] bool has_numbers_in_front() const {
    bool any = false;
    for_data_lines(lines_, [&](std::string_view line) { any = any || number_of(next_field(line)) > 0; });
    return any;
  }

  void add(char kind, std::string_view field) {
    const std::int64_t number = kind == '-' ? 0 : number_of(field);
    if (number == 0) return;
    const std::size_t dot = field.rfind('.');
    if (dot != std::string_view::npos) field.remove_prefix(dot + 1);
    found_.push_back({kind == 'n' ? Association::vertices : Association::cells,
                      static_cast<std::size_t>(field.data() - lines_.data()), field.size(), number});
  }

  /// Adds parameters such as REF NODE=17, and the element of a pre-tension section.
  void add_parameters(std::string_view keyword) {
    for (const std::string_view text : pieces_of(keyword)) {
      const std::size_t equals = text.find('=');
      if (equals == std::string_view::npos) continue;
      const std::string name = parameter_of(text).name;
      if (name == "NODE" || name == "REFNODE" || name == "ROTNODE") {
        add('n', trimmed_of_ends(text.substr(equals + 1)));
      } else if (name == "ELEMENT" && card_.keyword == "PRE-TENSIONSECTION") {
        add('e', trimmed_of_ends(text.substr(equals + 1)));
      }
    }
  }

  void add_fields(std::string_view line, std::string_view fields) {
    bool through_fluid = false;  // the third field is a node of the fluid, in CalculiX
    for (std::size_t k = 0; !line.empty(); ++k) {
      const std::string_view field = next_field(line);
      add(through_fluid && k == 2 ? 'n' : field_at(fields, k), field);
      through_fluid = k == 1 && names_fluid(field);
    }
  }

  /// Returns whether a load's label is for CalculiX's fluid networks: F1FC of *FILM, P1NP of *DLOAD.
  [[nodiscard]] bool names_fluid(std::string_view label) const {
    const std::string text = upper_case(label);
    return (card_.keyword == "FILM" && text.ends_with("FC")) ||
           (card_.keyword == "DLOAD" && text.ends_with("NP"));
  }

  /// Reads a line of *EQUATION: the number of terms, or terms (node, direction, coefficient).
  void add_terms(std::string_view line) {
    if (terms_left_ == 0) {
      terms_left_ = number_of(next_field(line));
      return;
    }
    while (!trimmed(line).empty() && terms_left_ > 0) {
      const std::string_view field = next_field(line);
      if (in_term_ == 0) add('n', field);
      if (in_term_ == 2) --terms_left_;
      in_term_ = (in_term_ + 1) % 3;
    }
  }

  const Card& card_;
  std::string_view lines_;
  std::vector<Reference> found_;
  std::int64_t terms_left_ = 0;  // terms of the present equation still to be read
  int in_term_ = 0;              // number of fields read of the present term
};

}  // namespace

bool has_other_file(const Card& card) { return card.has("INPUT") || card.has("FILE"); }

std::optional<std::vector<Reference>> references(const Card& card, std::string_view lines) {
  return ReferenceFinder(card, lines).find();
}

std::vector<NamedSet> named_sets(const Card& card, std::string_view lines) {
  constexpr std::array<std::string_view, 9> kKeywords{"BOUNDARY", "CFLUX",   "CLOAD",   "DFLUX",      "DLOAD",
                                                      "FILM",     "RADIATE", "SURFACE", "TEMPERATURE"};
  const bool is_of_surfaces = card.has("COMBINE") || card.has("CROP");
  const bool is_known = std::find(kKeywords.begin(), kKeywords.end(), card.keyword) != kKeywords.end();
  const auto fields = is_known && !is_of_surfaces ? fields_of(card) : std::nullopt;
  if (!fields || fields->empty()) return {};
  const Association association = fields->front() == 'n' ? Association::vertices : Association::cells;
  std::vector<NamedSet> sets;
  for_data_lines(lines, [&](std::string_view line) {
    const std::string_view field = without_quotes(next_field(line));
    const bool is_name = !field.empty() && std::isdigit(static_cast<unsigned char>(field.front())) == 0;
    if (is_name && number_of(field) == 0) sets.push_back({association, field});
  });
  return sets;
}

std::string suggested_keyword(const Card& card) {
  std::vector<std::string> names{"EQUATION", "INITIALCONDITIONS", "ORIENTATION", "SURFACE"};
  for (const LineFields& layout : kLayouts) {
    names.insert(names.end(), layout.keywords.begin(), layout.keywords.end());
  }
  names.insert(names.end(), kPlain.begin(), kPlain.end());
  if (std::find(names.begin(), names.end(), card.keyword) != names.end()) return {};
  for (std::string& name : names) name.insert(0, "*");
  return suggestion("*" + card.keyword, names);
}

bool depends_on_numbers(const Card& card) {
  const std::string& keyword = card.keyword;
  return keyword == "CYCLICSYMMETRYMODEL" || (keyword == "TIE" && card.has("CYCLICSYMMETRY")) ||
         ((keyword == "RESTART" || keyword == "VIEWFACTOR") && card.has("READ"));
}

bool pairs_sets(const Card& card, std::string_view lines) {
  const bool is_mpc = card.keyword == "MPC";
  if (!is_mpc && card.keyword != "EQUATION") return false;
  int names = 0;
  for_data_lines(lines, [&](std::string_view line) {
    if (is_mpc) (void)next_field(line);  // the type of the constraint
    while (!line.empty()) {
      const std::string_view field = next_field(line);
      const char first = field.empty() ? '0' : field.front();
      const bool is_name =
          std::isalpha(static_cast<unsigned char>(first)) != 0 || first == '_' || first == '"';
      if (is_name && number_of(field) == 0) ++names;
    }
  });
  return names > 1;
}

std::vector<std::int64_t> numbers_in(std::string_view lines) {
  std::vector<std::int64_t> numbers;
  const auto add = [&](std::string_view field) {
    if (const std::int64_t number = number_of(field); number > 0) numbers.push_back(number);
  };
  for (const Card::Parameter& parameter : parse_card(lines).parameters) add(parameter.value);
  for_data_lines(lines, [&](std::string_view line) {
    while (!line.empty()) add(next_field(line));
  });
  return numbers;
}

}  // namespace meshorder::abaqus
