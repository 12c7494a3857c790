#include "src/io/contents.h"

#include "needlework/error.h"
#include "src/io/source.h"

namespace needlework::io {

using hdf5::Handle;

struct Contents::Implementation {
  explicit Implementation(const std::string& path) : source(path) {}

  bool is_element(const std::string& path) const {
    return hdf5::is_dataset(source.get(), path + "/value", source.place(path));
  }
  bool holds_text(const std::string& path) const {
    const std::string place = source.place(path);
    const Handle dataset = hdf5::open_dataset(source.get(), path, place);
    const Handle type(H5Dget_type(dataset.get()), H5Tclose, place);
    return H5Tget_class(type.get()) == H5T_STRING;
  }

  Source source;
};

Contents::Contents(const std::string& path) {
  const hdf5::Session session;
  implementation_ = std::make_unique<Implementation>(path);
}

Contents::~Contents() {
  const hdf5::Session session;
  implementation_.reset();
}

bool Contents::has(const std::string& path) const {
  const hdf5::Session session;
  const Source& source = implementation_->source;
  return hdf5::exists(source.get(), path, source.place(path));
}

bool Contents::is_dataset(const std::string& path) const {
  const hdf5::Session session;
  const Source& source = implementation_->source;
  return hdf5::is_dataset(source.get(), path, source.place(path)) ||
         implementation_->is_element(path);
}

std::vector<std::string> Contents::names(const std::string& group) const {
  const hdf5::Session session;
  const Source& source = implementation_->source;
  const std::string place = source.place(group);
  if (!hdf5::is_group(source.get(), group, place)) return {};
  return hdf5::children(hdf5::open_group(source.get(), group, place).get(), place);
}

std::string Contents::description(const std::string& path) const {
  const hdf5::Session session;
  const Source& source = implementation_->source;
  const std::string place = source.place(path);
  if (!hdf5::exists(source.get(), path, place)) return {};
  const Handle object(H5Oopen(source.get(), path.c_str(), H5P_DEFAULT), H5Oclose, place);
  if (hdf5::check(H5Aexists(object.get(), "description"), place) == 0) return {};
  const auto texts = hdf5::read_strings_attribute(object.get(), "description", place);
  return texts.empty() ? "" : texts.front();
}

std::optional<std::vector<std::string>> Contents::texts(const std::string& path) const {
  const hdf5::Session session;
  const Source& source = implementation_->source;
  const std::string place = source.place(path);
  if (!hdf5::is_dataset(source.get(), path, place)) return std::nullopt;
  if (!implementation_->holds_text(path)) return std::nullopt;
  return hdf5::read_strings(hdf5::open_dataset(source.get(), path, place).get(), place);
}

std::vector<std::size_t> Contents::shape(const std::string& path) const {
  const hdf5::Session session;
  const Element element(implementation_->source, path);
  std::vector<std::size_t> shape(element.shape().begin(), element.shape().end());
  if (!shape.empty()) shape[0] = element.rows();
  return shape;
}

std::vector<double> Contents::numbers(const std::string& path) const {
  const hdf5::Session session;
  const Element element(implementation_->source, path);
  std::vector<double> values = element.read<double>(std::nullopt);
  if (!element.shape().empty()) values.resize(element.rows() * element.size(0));
  return values;
}

std::vector<double> Contents::rows(const std::string& path,
                                   std::span<const std::size_t> rows) const {
  const hdf5::Session session;
  const Element element(implementation_->source, path);
  std::vector<double> values;
  for (const std::size_t row : rows) {
    if (row >= element.rows()) {
      throw InputError(implementation_->source.place(element.name()) +
                       ": has fewer rows than the times of its group: expected one for each");
    }
    const std::vector<double> one = element.read<double>(row);
    values.insert(values.end(), one.begin(), one.end());
  }
  return values;
}

}  // namespace needlework::io
