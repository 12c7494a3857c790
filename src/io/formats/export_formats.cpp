#include "src/io/formats/export_formats.h"

#include <algorithm>

#include "src/io/formats/compression.h"
#include "src/io/formats/dynamo.h"
#include "src/io/formats/lammps.h"
#include "src/io/formats/pvd.h"
#include "src/io/formats/xyz.h"
#include "src/io/vtkhdf.h"

namespace needlework::io {
namespace {

class VtkhdfWriter : public FrameWriter {
 public:
  VtkhdfWriter(std::string path, bool force, const Material& material)
      : path_(std::move(path)), force_(force), lengths_(lengths_of(material)) {
    if (has_width(material)) diameters_ = diameters_of(material);
  }
  void add(const Frame& frame) override {
    write_vtkhdf(path_, force_, frame.state, lengths_, diameters_);
  }
  void publish() override {}

 private:
  std::string path_;
  bool force_;
  std::vector<double> lengths_, diameters_;
};

std::unique_ptr<FrameWriter> open_vtkhdf(const std::string& path, bool force,
                                         const Material& material) {
  return std::make_unique<VtkhdfWriter>(path, force, material);
}

}  // namespace

std::span<const ExportFormat> export_formats() {
  using Endings = std::vector<std::string_view>;
  static const ExportFormat formats[] = {
      {"vtkhdf", "a VTKHDF file", Endings{".vtkhdf", ".hdf"}, false, false, false, open_vtkhdf},
      {"pvd", "a collection of VTK files", Endings{".pvd"}, true, false, false, write_pvd},
      {"xyz", "an extended XYZ file", Endings{".xyz", ".extxyz"}, true, true, false, write_xyz},
      {"lammps", "a data file of LAMMPS", Endings{".data", ".lmp", ".lammps"}, false, true, false,
       write_lammps_data},
      {"lammps", "a dump of LAMMPS", Endings{".dump", ".lammpstrj"}, true, true, false,
       write_lammps_dump},
      {"dynamo", "a configuration of DynamO", Endings{".xml"}, false, true, true, write_dynamo},
  };
  return formats;
}

bool has_ending_of(const ExportFormat& format, std::string_view path) {
  if (format.compressible) path = without_compression(path);
  return std::any_of(format.endings.begin(), format.endings.end(),
                     [&](std::string_view ending) { return path.ends_with(ending); });
}

const ExportFormat* find_export_format(std::string_view name, std::string_view path, bool many) {
  const ExportFormat* other = nullptr;
  for (const ExportFormat& format : export_formats()) {
    if (!name.empty() && name != format.name) continue;
    if (has_ending_of(format, path)) return &format;
    if (!name.empty() && (!other || (many && !other->many))) other = &format;
  }
  return other;
}

}  // namespace needlework::io
