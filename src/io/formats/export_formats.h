// The formats in which frames are exported, and which of them a file name means.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "src/io/formats/frame_writer.h"
#include "src/io/formats/material.h"

namespace needlework::io {

struct ExportFormat {
  std::string_view name;                  ///< as in --to; LAMMPS has two formats
  std::string_view what;                  ///< "a VTKHDF file"
  std::vector<std::string_view> endings;  ///< of file names, the usual one first
  bool many;                              ///< whether it holds several frames
  bool compressible;                      ///< whether .gz or .bz2 may follow the ending
  bool whole_material;                    ///< whether the material must be complete
  std::unique_ptr<FrameWriter> (*open)(const std::string& path, bool force,
                                       const Material& material);
};

std::span<const ExportFormat> export_formats();

/// Whether the name of a file has an ending of the format.
bool has_ending_of(const ExportFormat& format, std::string_view path);

/// The format of this name, or of any name if `name` is empty, that the ending of `path` means.
/// Without a fitting ending, it is the first format of the name that holds several frames, if these
/// are asked for. nullptr if there is none.
const ExportFormat* find_export_format(std::string_view name, std::string_view path, bool many);

}  // namespace needlework::io
