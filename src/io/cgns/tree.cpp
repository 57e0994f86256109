// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/cgns/tree.hpp"

#include "base/run_scope.hpp"
#include "io/cgns/cgns_library.hpp"
#include "io/hdf5/session.hpp"
#include "io/stream/descriptor.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/read_limits.hpp"
#include "io/stream/scratch.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

// Reads and writes nodes with CGIO.

namespace meshorder::cgns {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 64;

/// Buffer for a text of a node. In a damaged file, ADF may give more bytes than CGIO promises.
using Text = std::array<char, 1024>;

/// Returns a text padded with zeros for CGIO, which always reads 33 bytes of a name or label and 3 of a
/// type.
Text padded(std::string_view text) {
  Text result{};
  std::copy_n(text.begin(), std::min(text.size(), result.size() - 1), result.begin());
  return result;
}

/// Returns a text from CGIO without the blanks that pad it in the file.
std::string without_filling(const Text& text) {
  const std::string_view whole(text.data());
  return std::string(whole.substr(0, whole.find_last_not_of(' ') + 1));
}

/// A file that CGIO has open.
class CgioFile {
 public:
  CgioFile(const fs::path& path, std::string name, int mode, int type) : name_(std::move(name)) {
    check(cgio_open_file(path.c_str(), mode, type, &number_), "the file");
  }
  ~CgioFile() {
    if (number_ > 0) cgio_close_file(number_);
  }
  CgioFile(const CgioFile&) = delete;
  CgioFile(CgioFile&&) = delete;
  CgioFile& operator=(const CgioFile&) = delete;
  CgioFile& operator=(CgioFile&&) = delete;

  [[nodiscard]] int number() const noexcept { return number_; }

  void close() { check(cgio_close_file(std::exchange(number_, 0)), "the file"); }

  [[nodiscard]] double root() const {
    double id = 0;
    check(cgio_get_root_id(number_, &id), "the root");
    return id;
  }

  /// Throws InputError with the library's message if a call failed.
  void check(int status, const std::string& place) const {
    if (status == CGIO_ERR_NONE) return;
    Text message{};
    cgio_error_message(message.data());
    throw InputError(name_, fmt::format("{}: {}", place, message.data()),
                     writing_ ? "is the disk full?" : "the file may be damaged");
  }

  [[noreturn]] void fail(const std::string& what,
                         const std::string& remedy = "the file may be damaged") const {
    throw InputError(name_, what, remedy);
  }

  void is_written() { writing_ = true; }

 private:
  int number_ = 0;
  bool writing_ = false;
  std::string name_;
};

class TreeReader {
 public:
  TreeReader(const CgioFile& file, std::uint64_t bytes, bool compressed)
      : file_(file), bytes_(bytes), compressed_(compressed), nodes_left_(bytes / 32 + 1024) {}

  Node read(double id, const std::string& parent, int depth) {
    poll();
    const int number = file_.number();
    const std::string place = parent.empty() ? "the root" : parent;
    if (depth > kDeepest || nodes_left_-- == 0) {
      file_.fail(place + ": nodes are too many or nested too deeply");
    }
    int link = 0;
    file_.check(cgio_is_link(number, id, &link), place);
    Node node;
    if (depth > 0) {
      Text text{};
      file_.check(cgio_get_name(number, id, text.data()), place);
      node.name = without_filling(text);
      if (node.name.empty()) file_.fail(place + " has a child without a name");
    }
    const std::string path = depth > 0 ? parent + "/" + node.name : std::string();
    if (link > 0) {
      file_.fail(path + " is a link to another node", "copy all into one file with cgnsconvert -l -f IN OUT");
    }
    if (depth > 0) read_data(id, path, node);
    int children = 0;
    file_.check(cgio_number_children(number, id, &children), place);
    if (children < 0 || static_cast<std::uint64_t>(children) > nodes_left_) {
      file_.fail(fmt::format("{} claims {} children", place, children));
    }
    std::vector<double> ids(static_cast<std::size_t>(children));
    int found = 0;
    if (children > 0) {
      file_.check(cgio_children_ids(number, id, 1, children, &found, ids.data()), place);
    }
    if (found != children) {
      file_.fail(fmt::format("{} has {} children and gives {}", place, children, found));
    }
    node.children.reserve(ids.size());
    for (const double child : ids) {
      node.children.push_back(read(child, path, depth + 1));
      cgio_release_id(number, child);
    }
    return node;
  }

 private:
  void read_data(double id, const std::string& path, Node& node) const {
    const int number = file_.number();
    Text label{};
    Text type{};
    file_.check(cgio_get_label(number, id, label.data()), path);
    file_.check(cgio_get_data_type(number, id, type.data()), path);
    node.label = without_filling(label);
    node.type = without_filling(type);
    if (node.type == "MT") return;
    const std::size_t width = size_of_type(node.type);
    if (width == 0) {
      file_.fail(fmt::format("{} has values of the type '{}'", path, node.type),
                 "known: C1, B1, I4, I8, U4, U8, R4 and R8");
    }
    int rank = 0;
    std::array<cgsize_t, CGIO_MAX_DIMENSIONS> dimensions{};
    file_.check(cgio_get_dimensions(number, id, &rank, dimensions.data()), path);
    if (rank == 0) return;
    std::uint64_t bytes = width;
    for (int k = 0; k < rank; ++k) {
      const std::int64_t length = dimensions[static_cast<std::size_t>(k)];
      const std::uint64_t most = compressed_ ? std::numeric_limits<std::uint32_t>::max() * width : bytes_;
      if (length < 0 || (bytes > 0 && static_cast<std::uint64_t>(length) > most / bytes)) {
        file_.fail(path + " claims more values than the file can hold", "the file may be cut short");
      }
      bytes *= static_cast<std::uint64_t>(length);
      node.dimensions.push_back(length);
    }
    if (const std::string fault = refused_claim(bytes, path); !fault.empty()) file_.fail(fault, kClaimRemedy);
    node.bytes.resize(bytes);
    if (bytes > 0) {
      file_.check(cgio_read_all_data(number, id, node.bytes.data()), path);
    }
  }

  const CgioFile& file_;
  std::uint64_t bytes_;
  bool compressed_;  ///< values may be compressed: the file's size does not bound them
  std::uint64_t nodes_left_;
};

class TreeWriter {
 public:
  TreeWriter(const CgioFile& file, const std::function<void(Node&)>& fill) : file_(file), fill_(fill) {}

  void write(const Node& node, double parent, const std::string& path) const {
    poll();
    if (node.field < 0) return write_filled(node, node.children, parent, path + "/" + node.name);
    Node filled{.name = node.name, .label = node.label, .field = node.field};
    fill_(filled);
    write_filled(filled, node.children, parent, path + "/" + node.name);
  }

 private:
  void write_filled(const Node& node, const std::vector<Node>& children, double parent,
                    const std::string& path) const {
    std::array<cgsize_t, CGIO_MAX_DIMENSIONS> dimensions{};
    for (std::size_t k = 0; k < node.dimensions.size(); ++k) {
      if (!std::in_range<cgsize_t>(node.dimensions[k])) {
        file_.fail(fmt::format("{} has {} values", path, node.dimensions[k]),
                   "use a build with a CGNS library of 64-bit sizes");
      }
      dimensions.at(k) = static_cast<cgsize_t>(node.dimensions[k]);
    }
    double id = 0;
    const auto rank = static_cast<int>(node.dimensions.size());
    // ADF cannot hold values of length 0
    const bool has_values = rank > 0 && !node.bytes.empty();
    const Text name = padded(node.name);
    const Text label = padded(node.label);
    const Text type = padded(has_values ? std::string_view(node.type) : "MT");
    file_.check(
        cgio_new_node(file_.number(), parent, name.data(), label.data(), type.data(), has_values ? rank : 0,
                      dimensions.data(), has_values ? node.bytes.data() : nullptr, &id),
        path);
    for (const Node& child : children) write(child, id, path);
    cgio_release_id(file_.number(), id);
  }

  const CgioFile& file_;
  const std::function<void(Node&)>& fill_;
};

Tree read_open(const InputFile& input, const FilePath& counted, const std::string& name) {
  const hdf5::Session session;
  const std::string path = input.path_for_libraries();
  int type = CGIO_FILE_NONE;
  if (cgio_check_file(path.c_str(), &type) != CGIO_ERR_NONE || type == CGIO_FILE_NONE) {
    throw InputError(name, "is neither an HDF5 nor an ADF file", "a CGNS file is one of these");
  }
  count_file(counted, input.size());
  Tree tree;
  tree.storage = type == CGIO_FILE_HDF5 ? Storage::hdf5 : Storage::adf;
  if (tree.storage == Storage::hdf5) {
    check_hdf5(path, name);
  } else {
    check_adf(input, name);
  }
  const CgioFile file(path, name, CGIO_MODE_READ, type);
  session.watch();
  TreeReader reader(file, input.size(), tree.storage == Storage::hdf5);
  tree.root = reader.read(file.root(), "", 0);
  session.require_no_fault(name);
  return tree;
}

void write_to_disk(const Tree& tree, const fs::path& path, const std::string& name,
                   const std::function<void(Node&)>& fill) {
  const hdf5::Session session;
  const int type = tree.storage == Storage::hdf5 ? CGIO_FILE_HDF5 : CGIO_FILE_ADF;
  CgioFile file(path, name, CGIO_MODE_WRITE, type);
  session.watch();
  file.is_written();
  const TreeWriter writer(file, fill);
  const double root = file.root();
  for (const Node& node : tree.root.children) writer.write(node, root, "");
  file.close();
  session.require_no_fault(name);  // the library does not check all results of its own calls
}

/// Returns the first node with that name or label, null if there is none.
template <class Nodes>
auto* first_with(std::string Node::*text, std::string_view wanted, Nodes& nodes) {
  const auto found =
      std::find_if(nodes.begin(), nodes.end(), [&](const Node& node) { return node.*text == wanted; });
  return found == nodes.end() ? nullptr : &*found;
}

}  // namespace

std::uint64_t Node::size() const {
  const std::size_t width = size_of_type(type);
  return width == 0 ? 0 : bytes.size() / width;
}

std::string Node::text() const {
  const std::size_t end = bytes.find_last_not_of(std::string_view(" \0", 2));
  return type == "C1" && end != std::string::npos ? bytes.substr(0, end + 1) : std::string();
}

const Node* Node::child_of_label(std::string_view wanted) const {
  return first_with(&Node::label, wanted, children);
}

Node* Node::child_of_label(std::string_view wanted) { return first_with(&Node::label, wanted, children); }

const Node* Node::child(std::string_view wanted) const { return first_with(&Node::name, wanted, children); }

Node* Node::child(std::string_view wanted) { return first_with(&Node::name, wanted, children); }

Node text_node(std::string name, std::string label, std::string_view text) {
  return {.name = std::move(name),
          .label = std::move(label),
          .type = "C1",
          .dimensions = {static_cast<std::int64_t>(text.size())},
          .bytes = std::string(text)};
}

Node integer_node(std::string name, std::string label, const std::vector<std::int32_t>& values) {
  Node node{.name = std::move(name),
            .label = std::move(label),
            .type = "I4",
            .dimensions = {static_cast<std::int64_t>(values.size())},
            .bytes = std::string(values.size() * sizeof(std::int32_t), '\0')};
  std::memcpy(node.bytes.data(), values.data(), node.bytes.size());
  return node;
}

std::size_t size_of_type(std::string_view type) {
  if (type == "C1" || type == "B1") return 1;
  if (type == "I4" || type == "U4" || type == "R4") return 4;
  if (type == "I8" || type == "U8" || type == "R8") return 8;
  return 0;
}

Tree read_tree(const FilePath& path) {
  constexpr std::string_view kGzip = "\x1f\x8b";
  if (path.store() == nullptr && path.is_file() && path.read_first(kGzip.size()) != kGzip) {
    return read_open(path.open(), path, path.string());
  }
  const std::string bytes = path.read();
  const PrivateFolder folder;
  const fs::path copy = folder.path() / "mesh.cgns";
  Descriptor file(copy, O_WRONLY | O_CREAT | O_EXCL, S_IRUSR | S_IWUSR);
  int error = file.is_open() ? file.write(bytes) : errno;
  if (const int closing = file.close(); error == 0) error = closing;
  if (error != 0) {
    throw InputError(copy.string(), "a temporary file cannot be written: " + system_fault(error).reason,
                     "set TMPDIR to a folder with enough space");
  }
  return read_open(InputFile(copy), copy, path.string());
}

void write_tree(const Tree& tree, const FilePath& path, const std::function<void(Node&)>& fill) {
  OutputFile out(path);
  if (path.store() == nullptr) {
    out.close();
    write_to_disk(tree, out.temporary(), path.string(), fill);
  } else {
    const PrivateFolder folder;
    const fs::path written = folder.path() / "mesh.cgns";
    write_to_disk(tree, written, path.string(), fill);
    out.write(FilePath(written).read_first(std::numeric_limits<std::size_t>::max()));
  }
  out.commit();
}

}  // namespace meshorder::cgns
