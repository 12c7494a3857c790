#include "src/io/contents.h"

#include "needlework/error.h"
#include "src/io/in_child_process.h"
#include "src/io/source.h"

namespace needlework::io {

using hdf5::Handle;

// The members of Contents, where the file is open.
class OpenContents {
 public:
  explicit OpenContents(const std::string& path) : source_(path) {}

  bool has(const std::string& path) const;
  bool is_dataset(const std::string& path) const;
  std::vector<std::string> names(const std::string& group) const;
  std::string description(const std::string& path) const;
  std::optional<std::vector<std::string>> texts(const std::string& path) const;
  std::vector<std::size_t> shape(const std::string& path) const;
  std::vector<double> numbers(const std::string& path) const;
  std::vector<double> rows(const std::string& path, const std::vector<std::size_t>& rows) const;

 private:
  bool is_element(const std::string& path) const {
    return hdf5::is_dataset(source_.get(), path + "/value", source_.place(path));
  }
  bool holds_text(const std::string& path) const {
    const std::string place = source_.place(path);
    const Handle dataset = hdf5::open_dataset(source_.get(), path, place);
    const Handle type(H5Dget_type(dataset.get()), H5Tclose, place);
    return H5Tget_class(type.get()) == H5T_STRING;
  }

  Source source_;
};

bool OpenContents::has(const std::string& path) const {
  return hdf5::exists(source_.get(), path, source_.place(path));
}

bool OpenContents::is_dataset(const std::string& path) const {
  return hdf5::is_dataset(source_.get(), path, source_.place(path)) || is_element(path);
}

std::vector<std::string> OpenContents::names(const std::string& group) const {
  const std::string place = source_.place(group);
  if (!hdf5::is_group(source_.get(), group, place)) return {};
  return hdf5::children(hdf5::open_group(source_.get(), group, place).get(), place);
}

std::string OpenContents::description(const std::string& path) const {
  const std::string place = source_.place(path);
  if (!hdf5::exists(source_.get(), path, place)) return {};
  const Handle object = hdf5::open_object(source_.get(), path, place);
  if (hdf5::check(H5Aexists(object.get(), "description"), place) == 0) return {};
  const auto texts = hdf5::read_strings_attribute(object.get(), "description", place);
  return texts.empty() ? "" : texts.front();
}

std::optional<std::vector<std::string>> OpenContents::texts(const std::string& path) const {
  const std::string place = source_.place(path);
  if (!hdf5::is_dataset(source_.get(), path, place)) return std::nullopt;
  if (!holds_text(path)) return std::nullopt;
  return hdf5::read_strings(hdf5::open_dataset(source_.get(), path, place).get(), place);
}

std::vector<std::size_t> OpenContents::shape(const std::string& path) const {
  const Element element(source_, path);
  std::vector<std::size_t> shape(element.shape().begin(), element.shape().end());
  if (!shape.empty()) shape[0] = element.rows();
  return shape;
}

std::vector<double> OpenContents::numbers(const std::string& path) const {
  const Element element(source_, path);
  std::vector<double> values = element.read<double>(std::nullopt);
  if (!element.shape().empty()) values.resize(element.rows() * element.size(0));
  return values;
}

std::vector<double> OpenContents::rows(const std::string& path,
                                       const std::vector<std::size_t>& rows) const {
  const Element element(source_, path);
  std::vector<double> values;
  for (const std::size_t row : rows) {
    if (row >= element.rows()) {
      throw InputError(source_.place(element.name()) +
                       ": has fewer rows than the times of its group: expected one for each");
    }
    const std::vector<double> one = element.read<double>(row);
    values.insert(values.end(), one.begin(), one.end());
  }
  return values;
}

struct Contents::Implementation {
  explicit Implementation(const std::string& path)
      : file(path, [&] { return std::make_unique<OpenContents>(path); }) {}

  InChildProcess<OpenContents> file;
};

Contents::Contents(const std::string& path)
    : implementation_(std::make_unique<Implementation>(path)) {}

Contents::~Contents() = default;

bool Contents::has(const std::string& path) const {
  return implementation_->file.call<&OpenContents::has>(path);
}

bool Contents::is_dataset(const std::string& path) const {
  return implementation_->file.call<&OpenContents::is_dataset>(path);
}

std::vector<std::string> Contents::names(const std::string& group) const {
  return implementation_->file.call<&OpenContents::names>(group);
}

std::string Contents::description(const std::string& path) const {
  return implementation_->file.call<&OpenContents::description>(path);
}

std::optional<std::vector<std::string>> Contents::texts(const std::string& path) const {
  return implementation_->file.call<&OpenContents::texts>(path);
}

std::vector<std::size_t> Contents::shape(const std::string& path) const {
  return implementation_->file.call<&OpenContents::shape>(path);
}

std::vector<double> Contents::numbers(const std::string& path) const {
  return implementation_->file.call<&OpenContents::numbers>(path);
}

std::vector<double> Contents::rows(const std::string& path,
                                   std::span<const std::size_t> rows) const {
  return implementation_->file.call<&OpenContents::rows>(
      path, std::vector<std::size_t>(rows.begin(), rows.end()));
}

}  // namespace needlework::io
