#include "src/io/formats/vtu.h"

#include <fmt/ranges.h>

#include <bit>
#include <cstring>

namespace needlework::io {
namespace {

static_assert(std::endian::native == std::endian::little ||
              std::endian::native == std::endian::big);
constexpr const char* byte_order =
    std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

template <class Number>
std::string bytes_of(const std::vector<Number>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)};
}

}  // namespace

void VtuFile::begin(std::string_view part) {
  if (!part_.empty()) description_ += fmt::format("      </{}>\n", part_);
  part_ = part;
  description_ += fmt::format("      <{}>\n", part);
}

void VtuFile::add_bytes(std::string_view name, std::string_view type, int components,
                        std::string bytes) {
  description_ += fmt::format(
      "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
      "offset=\"{}\"/>\n",
      type, name, components, offset_);
  offset_ += sizeof(std::uint64_t) + bytes.size();
  bytes_.push_back(std::move(bytes));
}

void VtuFile::add(std::string_view name, std::vector<double> values, int components) {
  add_bytes(name, "Float64", components, bytes_of(values));
}

void VtuFile::add(std::string_view name, std::vector<std::int64_t> values) {
  add_bytes(name, "Int64", 1, bytes_of(values));
}

void VtuFile::add(std::string_view name, std::vector<std::uint8_t> values) {
  add_bytes(name, "UInt8", 1, bytes_of(values));
}

void VtuFile::add_field(std::string_view name, std::span<const int> values) {
  field_ += fmt::format(
      "    <FieldData>\n      <DataArray type=\"Int32\" Name=\"{}\" NumberOfTuples=\"{}\" "
      "format=\"ascii\">{}</DataArray>\n    </FieldData>\n",
      name, values.size(), fmt::join(values, " "));
}

void VtuFile::publish(std::size_t points, std::size_t cells) {
  file_.print(R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="{}" header_type="UInt64">
  <UnstructuredGrid>
{}    <Piece NumberOfPoints="{}" NumberOfCells="{}">
{}      </{}>
    </Piece>
  </UnstructuredGrid>
  <AppendedData encoding="raw">
_)",
              byte_order, field_, points, cells, description_, part_);
  // Each array follows its size in bytes.
  for (const std::string& bytes : bytes_) {
    const std::uint64_t size = bytes.size();
    char head[sizeof size];
    std::memcpy(head, &size, sizeof size);
    file_.write({head, sizeof head});
    file_.write(bytes);
  }
  file_.print("\n  </AppendedData>\n</VTKFile>\n");
  file_.publish();
}

}  // namespace needlework::io
