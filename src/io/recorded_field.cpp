#include "src/io/recorded_field.h"

#include "src/io/source.h"

namespace needlework::io {

RecordedField read_field(const std::string& path, const std::string& name) {
  const hdf5::Session session;
  const Source source(path);
  const Element element(source, "/series/" + name);
  RecordedField field;
  field.values = element.read<double>(std::nullopt);
  const hdf5::Shape& shape = element.shape();
  if (const auto times = element.times()) {
    field.times = *times;
    field.times.resize(element.rows());
    field.shape.assign(shape.begin() + 1, shape.end());
    std::size_t width = 1;
    for (const std::size_t extent : field.shape) width *= extent;
    field.values.resize(field.times.size() * width);
  } else {
    field.shape.assign(shape.begin(), shape.end());
  }
  return field;
}

}  // namespace needlework::io
