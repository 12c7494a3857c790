// What each dataset and group in the files of this library means.
#pragma once

#include <hdf5.h>

#include <string>
#include <vector>

#include "needlework/series.h"

namespace needlework::io {

/// The meaning of one dataset or group.
struct Description {
  /// Path in the file. A `*` stands for any one name, so that one description can serve many
  /// objects. When several descriptions fit an object, the first one holds.
  std::string path;
  std::string meaning;
  std::string unit;   ///< in words; empty where there is none
  std::string shape;  ///< such as "[frames][3]" or "scalar"; empty for most groups
};

/// The description as one sentence, "MEANING, in units of UNIT, with shape SHAPE.", without the
/// parts that do not apply.
std::string sentence(const Description& description);

std::vector<Description> run_file_descriptions();  ///< files of a Writer
std::vector<Description> mixture_descriptions();
std::vector<Description> passing_descriptions();   ///< where some species pass through each other
std::vector<Description> own_body_descriptions();  ///< where bodies of a species differ
std::vector<Description> rod_descriptions(bool of_each_species);  ///< of rods of finite width
std::vector<Description> event_kind_descriptions();               ///< where events have kinds
std::vector<Description> wall_descriptions();                     ///< where there are walls
std::vector<Description> growth_descriptions();                   ///< of bodies that grow
std::vector<Description> moving_wall_descriptions();              ///< of walls with a velocity
std::vector<Description> shear_descriptions();                    ///< of uniform shear
std::vector<Description> series_descriptions(                     ///< and their groups in /series
    const std::vector<SeriesGroup>& groups);
std::vector<Description> sweep_summary_descriptions();  ///< files of sweep::write_summary
std::vector<Description> vtkhdf_descriptions();         ///< files of write_vtkhdf

/// Gives each object of the file that one of the descriptions fits an attribute `description`, a
/// variable-length UTF-8 string. The description of an H5MD element, which is a group, goes to its
/// dataset `value` as well. `place` begins the messages of errors.
void write_descriptions(hid_t file, const std::vector<Description>& descriptions,
                        const std::string& place);

}  // namespace needlework::io
