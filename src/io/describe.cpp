// The text that shows people what a file contains.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "src/io/in_child_process.h"
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

std::string read_text(hid_t object, const std::string& name, const std::string& place) {
  if (hdf5::check(H5Aexists(object, name.c_str()), place) == 0) return "unknown";
  return fmt::format("{}", fmt::join(hdf5::read_strings_attribute(object, name, place), ", "));
}

// "1 frame", "2 frames"
std::string format_count(hsize_t count, const char* kind) {
  return fmt::format("{} {}{}", count, kind, count == 1 ? "" : "s");
}

std::string format_range(const char* name, const std::vector<double>& values) {
  if (values.empty()) return {};
  return fmt::format(", {} {:.6g} to {:.6g}", name, values.front(), values.back());
}

std::string format_range(const char* name, const std::vector<std::int64_t>& values) {
  if (values.empty()) return {};
  return fmt::format(", {} {} to {}", name, values.front(), values.back());
}

// The first and last time and step of an element, as far as it has them.
std::string format_ranges(const Element& element) {
  return format_range("time", element.times().value_or(std::vector<double>())) +
         format_range("step", element.steps().value_or(std::vector<std::int64_t>()));
}

// How numbers differ; nothing of one number.
std::string format_spread(const char* name, const std::vector<double>& values) {
  const auto [least, greatest] = std::ranges::minmax(values);
  if (std::isinf(least)) return "fixed";
  if (!(least < greatest)) return {};
  const double count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value / mean - 1) * (value / mean - 1);
  return fmt::format("{} of mean {:.4g}, width {:.3g}, from {:.3g} to {:.3g}", name, mean,
                     std::sqrt(squares / count), least, greatest);
}

class Overview {
 public:
  explicit Overview(const std::string& path) : source_(path) {}

  std::string write();

 private:
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    const std::string line = fmt::format(format, std::forward<Arguments>(arguments)...);
    text_ += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }

  void add_origin();
  void add_particles();
  void add_sizes(const std::string& group);
  std::vector<double> numbers(const std::string& path) const;
  bool has_rows(const std::string& group) const;
  void add_rows(const std::string& group, const char* kind);
  void add_events();
  void add_datasets();
  void add_group(const std::string& path, int depth);
  void add_object(const std::string& path, const std::string& name, int depth);
  void add_dataset(const std::string& path, const std::string& name, int depth);
  void add_description(const std::string& path, int depth);
  void add_boundary(const std::string& path, int depth);
  std::string description(const std::string& path) const;
  void add_parameters();
  std::vector<std::string> children(const std::string& path) const;
  bool is_element(const std::string& path) const;

  Source source_;
  std::string text_;
  std::map<std::uint64_t, std::string> groups_shown_;  // paths by number; links can form a cycle
  std::set<std::string> ranges_shown_;  // of times and steps, which elements need not repeat
};

std::string Overview::write() {
  add("{}: {}", source_.path(), format_bytes(source_.bytes()));
  add_origin();
  if (const std::string text = description("/"); !text.empty()) add("{}", text);
  add_particles();
  add_rows("/series", "sample");
  for (const auto& [group, kind] :
       {std::pair("/velocities_set", "change"), {"/user_data", "value"}}) {
    if (has_rows(group)) add_rows(group, kind);
  }
  add_events();
  add_datasets();
  if (hdf5::is_group(source_.get(), "/parameters", source_.path())) add_parameters();
  return text_;
}

void Overview::add_origin() {
  const std::string place = source_.place("/h5md");
  if (!hdf5::is_group(source_.get(), "/h5md", place)) {
    add("HDF5, but not H5MD: there is no group /h5md");
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

void Overview::add_particles() {
  const std::string root = "/particles";
  if (!hdf5::is_group(source_.get(), root, source_.place(root))) return;
  for (const std::string& name : children(root)) {
    const std::string path = root + "/" + name + "/position";
    if (!is_element(path)) continue;
    const Element position(source_, path);
    if (position.shape().size() != 3) continue;
    const std::string range = format_ranges(position);
    add("{}/{}: {}, {}{}", root, name, format_count(position.shape()[1], "particle"),
        format_count(position.rows(), "frame"), range);
    ranges_shown_.insert(range);
    add_sizes(root + "/" + name + "/");
  }
}

// Of a dataset with one number for each particle, or none.
std::vector<double> Overview::numbers(const std::string& path) const {
  const std::string place = source_.place(path);
  if (!hdf5::is_dataset(source_.get(), path, place)) return {};
  const std::string type =
      hdf5::type_name(hdf5::open_dataset(source_.get(), path, place).get(), place);
  if (type == "string" || type == "other") return {};
  const Element element(source_, path);
  return element.shape().size() == 1 ? element.read<double>({}) : std::vector<double>();
}

// In what particles differ within a species, and which are fixed.
void Overview::add_sizes(const std::string& group) {
  std::vector<double> species = numbers(group + "species");
  const std::vector<double> masses = numbers(group + "mass");
  species.resize(masses.size());
  std::map<double, std::string> lines;
  for (const char* name : {"length", "diameter", "mass"}) {
    const std::vector<double> all = numbers(group + name);
    if (all.size() != masses.size()) continue;
    std::map<double, std::vector<double>> by_species;
    for (std::size_t i = 0; i < all.size(); ++i) by_species[species[i]].push_back(all[i]);
    for (const auto& [index, of] : by_species) {
      if (const std::string text = format_spread(name, of); !text.empty()) {
        std::string& line = lines[index];
        line += (line.empty() ? "" : "; ") + text;
      }
    }
  }
  const std::string path = "/parameters/species";
  std::vector<std::string> names;
  if (hdf5::is_dataset(source_.get(), path, source_.place(path))) {
    const Handle dataset = hdf5::open_dataset(source_.get(), path, source_.place(path));
    if (hdf5::type_name(dataset.get(), source_.place(path)) == "string")
      names = hdf5::read_strings(dataset.get(), source_.place(path));
  }
  for (const auto& [index, line] : lines) {
    const bool is_named = index >= 0 && index < static_cast<double>(names.size());
    add("  {}{}", is_named ? names[static_cast<std::size_t>(index)] + ": " : "", line);
  }
}

bool Overview::has_rows(const std::string& group) const {
  const std::string steps = group + "/step";
  return hdf5::is_dataset(source_.get(), steps, source_.place(steps)) &&
         Element(source_, steps).rows() > 0;
}

// For a group whose rows have their times in its dataset `time`, and perhaps steps in `step`.
void Overview::add_rows(const std::string& group, const char* kind) {
  if (!hdf5::is_dataset(source_.get(), group + "/time", source_.place(group))) return;
  const Element time(source_, group + "/time");
  if (time.shape().size() != 1) return;
  std::string range = format_range("time", time.read<double>({}));
  if (hdf5::is_dataset(source_.get(), group + "/step", source_.place(group))) {
    range += format_range("step", Element(source_, group + "/step").read<std::int64_t>({}));
  }
  add("{}: {}{}", group, format_count(time.rows(), kind), range);
  ranges_shown_.insert(range);
}

void Overview::add_events() {
  const std::string kinds = "/events/kind";
  if (!hdf5::is_dataset(source_.get(), kinds, source_.place(kinds))) {
    return add_rows("/events", "collision");
  }
  add_rows("/events", "event");
  std::map<std::uint64_t, std::uint64_t> counts;
  const auto found = Element(source_, kinds).read<std::uint64_t>({});
  const std::size_t rows = Element(source_, "/events/time").rows();
  for (std::size_t n = 0; n < std::min(rows, found.size()); ++n) ++counts[found[n]];
  for (const auto& [kind, count] : counts) {
    const bool known = kind <= std::numeric_limits<std::uint8_t>::max();
    add("  {} of kind {} ({})", count, kind,
        known ? name_of(static_cast<Happening::Kind>(kind)) : "unknown");
  }
}

void Overview::add_datasets() {
  add("");
  add("Groups and datasets with their types, shapes and meanings.");
  if (!ranges_shown_.empty()) {
    add("Each row of GROUP/value has its time in GROUP/time and the collisions so far in "
        "GROUP/step.");
  }
  groups_shown_.emplace(hdf5::number_of(source_.get(), "/", source_.path()), "/");
  for (const std::string& name : children("/")) {
    if (name == "h5md" || name == "parameters") continue;
    add("");
    add_object("/" + name, name, 0);
  }
}

std::string Overview::description(const std::string& path) const {
  const std::string place = source_.place(path);
  const Handle object = hdf5::open_object(source_.get(), path, place);
  if (hdf5::check(H5Aexists(object.get(), "description"), place) == 0) return {};
  const auto texts = hdf5::read_strings_attribute(object.get(), "description", place);
  return texts.empty() ? "" : texts.front();
}

void Overview::add_description(const std::string& path, int depth) {
  const std::string text = description(path);
  if (!text.empty()) add("{:{}}{}", "", 2 * depth + 4, text);
}

// Of a box, along each axis.
void Overview::add_boundary(const std::string& path, int depth) {
  const std::string place = source_.place(path);
  const Handle object = hdf5::open_object(source_.get(), path, place);
  if (hdf5::check(H5Aexists(object.get(), "boundary"), place) == 0) return;
  add("{:{}}boundary: {}", "", 2 * depth + 4, read_text(object.get(), "boundary", place));
}

std::vector<std::string> Overview::children(const std::string& path) const {
  const std::string place = source_.place(path);
  return hdf5::children(hdf5::open_group(source_.get(), path, place).get(), place);
}

bool Overview::is_element(const std::string& path) const {
  return hdf5::is_dataset(source_.get(), path + "/value", source_.place(path));
}

void Overview::add_group(const std::string& path, int depth) {
  if (depth > 6) return;
  const std::vector<std::string> names = children(path);
  // Step and time of elements that share them are not repeated.
  const bool elements = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return hdf5::is_group(source_.get(), path + "/" + name, source_.place(path)) &&
           is_element(path + "/" + name);
  });
  for (const std::string& name : names) {
    if (elements && (name == "step" || name == "time") && !is_element(path + "/" + name)) continue;
    add_object(path + "/" + name, name, depth);
  }
}

void Overview::add_object(const std::string& path, const std::string& name, int depth) {
  const std::string place = source_.place(path);
  if (hdf5::is_dataset(source_.get(), path, place)) {
    add_dataset(path, name, depth);
  } else if (!hdf5::is_group(source_.get(), path, place)) {
    add("{:{}}{}: cannot be read", "", 2 * depth, name);
  } else if (is_element(path)) {
    add_dataset(path + "/value", name + "/value", depth);
  } else {
    const auto [shown, is_new] =
        groups_shown_.emplace(hdf5::number_of(source_.get(), path, place), path);
    add("{:{}}{}{}", "", 2 * depth, name, is_new ? "" : ": the same as " + shown->second);
    if (!is_new) return;
    add_description(path, depth);
    add_boundary(path, depth);
    add_group(path, depth + 1);
  }
}

void Overview::add_dataset(const std::string& path, const std::string& name, int depth) {
  const std::string place = source_.place(path);
  const Handle dataset = hdf5::open_dataset(source_.get(), path, place);
  const std::string type = hdf5::type_name(dataset.get(), place);
  std::string line = fmt::format("{:{}}{:<{}} {:<8} {}", "", 2 * depth, name, 28 - 2 * depth, type,
                                 hdf5::to_string(hdf5::shape_of(dataset.get(), place)));
  if (path.ends_with("/value") && type != "string" && type != "other") {
    const std::string range = format_ranges(Element(source_, path.substr(0, path.size() - 6)));
    if (!ranges_shown_.contains(range)) line += range;
  }
  add("{}", line);
  add_description(path, depth);
}

void Overview::add_parameters() {
  add("");
  add("parameters");
  std::string long_texts;
  for (const std::string& name : children("/parameters")) {
    const std::string path = "/parameters/" + name;
    const std::string place = source_.place(path);
    if (!hdf5::is_dataset(source_.get(), path, place)) {
      add_object(path, name, 1);
      continue;
    }
    const Handle dataset = hdf5::open_dataset(source_.get(), path, place);
    const hdf5::Shape shape = hdf5::shape_of(dataset.get(), place);
    const std::string type = hdf5::type_name(dataset.get(), place);
    const auto add_value = [&](const auto& value) {
      add("  {:<14} {:<22} {}", name, value, description(path));
    };
    if (!shape.empty() || type == "other") {
      add_dataset(path, name, 1);
    } else if (type == "string") {
      const std::string text = hdf5::read_strings(dataset.get(), place).at(0);
      if (text.find('\n') == std::string::npos) {
        add_value(text);
      } else {
        long_texts += fmt::format("\n{}:\n{}{}", name, text, text.ends_with('\n') ? "" : "\n");
      }
    } else if (type.starts_with("float")) {
      add_value(Element(source_, path).read<double>({}).at(0));
    } else if (type.starts_with("u")) {
      add_value(Element(source_, path).read<std::uint64_t>({}).at(0));
    } else {
      add_value(Element(source_, path).read<std::int64_t>({}).at(0));
    }
  }
  text_ += long_texts;
}

}  // namespace

std::string describe(const std::string& path) {
  return read_in_child_process(path, [&] { return Overview(path).write(); });
}

}  // namespace needlework::io
