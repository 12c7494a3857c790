// What is in a file, for people.
#include <fmt/format.h>

#include <algorithm>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/source.h"

namespace needlework::io {

using hdf5::Handle;

namespace {

std::string format_bytes(std::uint64_t bytes) {
  if (bytes < 1000) return fmt::format("{} bytes", bytes);
  double size = static_cast<double>(bytes);
  const char* unit = "bytes";
  for (const char* larger : {"kB", "MB", "GB", "TB"}) {
    if (size < 1000) break;
    size /= 1000;
    unit = larger;
  }
  return fmt::format("{:.1f} {}", size, unit);
}

// "float64", "int32", "string"
std::string type_name(hid_t dataset, const std::string& place) {
  const Handle type(H5Dget_type(dataset), H5Tclose, place);
  const std::size_t bits = 8 * H5Tget_size(type.get());
  switch (H5Tget_class(type.get())) {
    case H5T_FLOAT:
      return fmt::format("float{}", bits);
    case H5T_INTEGER:
      return fmt::format("{}int{}", H5Tget_sign(type.get()) == H5T_SGN_NONE ? "u" : "", bits);
    case H5T_STRING:
      return "string";
    default:
      return "other";
  }
}

std::string read_text(hid_t object, const std::string& name, const std::string& place) {
  if (hdf5::check(H5Aexists(object, name.c_str()), place) == 0) return "unknown";
  return fmt::format("{}", fmt::join(hdf5::read_strings_attribute(object, name, place), ", "));
}

class Description {
 public:
  explicit Description(const std::string& path) : source_(path) {}

  std::string write();

 private:
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    text_ += fmt::format(format, std::forward<Arguments>(arguments)...) + '\n';
  }

  void add_origin();
  void add_size();
  void add_group(const std::string& path, int depth);
  void add_object(const std::string& path, const std::string& name, int depth);
  void add_dataset(const std::string& path, const std::string& name, int depth);
  std::string format_range(const Element& element) const;
  void add_parameters();
  std::vector<std::string> children(const std::string& path) const;
  bool is_element(const std::string& path) const;

  Source source_;
  std::string text_;
};

std::string Description::write() {
  add("{}: {}", source_.path(), format_bytes(source_.bytes()));
  add_origin();
  add_size();
  for (const std::string& name : children("/")) {
    if (name == "h5md" || name == "parameters") continue;
    add_object("/" + name, name, 0);
  }
  if (hdf5::is_group(source_.get(), "/parameters", source_.path())) add_parameters();
  return text_;
}

void Description::add_origin() {
  const std::string place = source_.place("/h5md");
  if (!hdf5::is_group(source_.get(), "/h5md", place)) {
    add("an HDF5 file without the group h5md, so not H5MD");
    return;
  }
  const Handle group = hdf5::open_group(source_.get(), "/h5md", place);
  std::string version = "of unknown version";
  if (hdf5::check(H5Aexists(group.get(), "version"), place) > 0) {
    const Handle attribute(H5Aopen(group.get(), "version", H5P_DEFAULT), H5Aclose, place);
    const Handle space(H5Aget_space(attribute.get()), H5Sclose, place);
    std::vector<int> numbers(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
    hdf5::check(H5Aread(attribute.get(), H5T_NATIVE_INT, numbers.data()), place);
    version = fmt::format("{}", fmt::join(numbers, "."));
  }
  std::string creator = "unknown";
  if (hdf5::is_group(source_.get(), "/h5md/creator", place)) {
    const Handle by = hdf5::open_group(source_.get(), "/h5md/creator", place);
    creator = read_text(by.get(), "name", place) + " " + read_text(by.get(), "version", place);
  }
  add("H5MD {}, written by {}", version, creator);
}

// The sizes that people look for first.
void Description::add_size() {
  const std::string root = "/particles";
  if (!hdf5::is_group(source_.get(), root, source_.place(root))) return;
  for (const std::string& name : children(root)) {
    const std::string path = root + "/" + name + "/position";
    if (!is_element(path)) continue;
    const Element position(source_, path);
    if (position.shape().size() != 3) continue;
    add("{}/{}: {} particles, {} frame{}", root, name, position.shape()[1], position.rows(),
        position.rows() == 1 ? "" : "s");
  }
}

std::vector<std::string> Description::children(const std::string& path) const {
  const std::string place = source_.place(path);
  return hdf5::children(hdf5::open_group(source_.get(), path, place).get(), place);
}

bool Description::is_element(const std::string& path) const {
  return hdf5::is_dataset(source_.get(), path + "/value", source_.place(path));
}

void Description::add_group(const std::string& path, int depth) {
  const std::vector<std::string> names = children(path);
  // Links may go round in circles.
  if (depth > 6) return;
  // The step and time of a group stand with its elements.
  const bool elements = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return hdf5::is_group(source_.get(), path + "/" + name, path) && is_element(path + "/" + name);
  });
  for (const std::string& name : names) {
    if (elements && (name == "step" || name == "time")) continue;
    add_object(path + "/" + name, name, depth);
  }
}

void Description::add_object(const std::string& path, const std::string& name, int depth) {
  const std::string place = source_.place(path);
  if (hdf5::is_dataset(source_.get(), path, place)) {
    add_dataset(path, name, depth);
  } else if (!hdf5::is_group(source_.get(), path, place)) {
    add("{:{}}{}: not readable here", "", 2 * depth, name);
  } else if (is_element(path)) {
    add_dataset(path + "/value", name, depth);
  } else {
    add("{:{}}{}", "", 2 * depth, name);
    add_group(path, depth + 1);
  }
}

void Description::add_dataset(const std::string& path, const std::string& name, int depth) {
  const std::string place = source_.place(path);
  const Handle dataset = hdf5::open_dataset(source_.get(), path, place);
  const std::string type = type_name(dataset.get(), place);
  std::string line = fmt::format("{:{}}{:<{}} {:<8} {:<16}", "", 2 * depth, name, 22 - 2 * depth,
                                 type, hdf5::to_string(hdf5::shape_of(dataset.get(), place)));
  if (path.ends_with("/value") && type != "string" && type != "other") {
    line += format_range(Element(source_, path.substr(0, path.size() - 6)));
  } else if (path == "/events/time") {
    const Element times(source_, path);
    if (times.rows() > 0) {
      line += fmt::format(" {} to {}", times.read<double>(0).at(0),
                          times.read<double>(times.rows() - 1).at(0));
    }
  }
  add("{}", line.substr(0, line.find_last_not_of(' ') + 1));
}

std::string Description::format_range(const Element& element) const {
  std::string text;
  const auto add_range = [&](const char* name, const auto& values) {
    if (values && !values->empty()) {
      text += fmt::format(" {} {} to {} ", name, values->front(), values->back());
    }
  };
  add_range("time", element.times());
  add_range("step", element.steps());
  return text;
}

void Description::add_parameters() {
  add("parameters");
  std::string long_texts;
  for (const std::string& name : children("/parameters")) {
    const std::string path = "/parameters/" + name;
    const std::string place = source_.place(path);
    if (!hdf5::is_dataset(source_.get(), path, place)) continue;
    const Handle dataset = hdf5::open_dataset(source_.get(), path, place);
    const hdf5::Shape shape = hdf5::shape_of(dataset.get(), place);
    const std::string type = type_name(dataset.get(), place);
    if (!shape.empty() || type == "other") {
      add_dataset(path, name, 1);
    } else if (type == "string") {
      const std::string text = hdf5::read_strings(dataset.get(), place).at(0);
      if (text.find('\n') == std::string::npos) {
        add("  {:<20} {}", name, text);
      } else {
        long_texts += fmt::format("{}:\n{}{}", name, text, text.ends_with('\n') ? "" : "\n");
      }
    } else if (type.starts_with("float")) {
      add("  {:<20} {}", name, Element(source_, path).read<double>({}).at(0));
    } else if (type.starts_with("u")) {
      add("  {:<20} {}", name, Element(source_, path).read<std::uint64_t>({}).at(0));
    } else {
      add("  {:<20} {}", name, Element(source_, path).read<std::int64_t>({}).at(0));
    }
  }
  text_ += long_texts;
}

}  // namespace

std::string describe(const std::string& path) {
  const hdf5::Session session;
  return Description(path).write();
}

}  // namespace needlework::io
