// The needles of a file's frames, as the page draws them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "needlework/scene.h"
#include "src/report/arrays.h"
#include "src/report/thinning.h"

namespace needlework::report {

/// Of each species.
struct BodySizes {
  std::vector<double> lengths = {1.0};  ///< of axes [L]
  std::vector<double> diameters = {};   ///< of rods of finite width; none of needles [L]
};

/// Reads the frames of an H5MD file: box, along which axes it is periodic, axis, side and kind of
/// each wall, numbers of needles and frames in the file and of those shown, and for each frame its
/// time, the corners `low` and `high` of the part of space that is drawn (see picture::region_of;
/// at an open side it ends with the needles of this frame and those after it), the place of each
/// wall, and arrays of the needles shown [n]. `position` [n][3] is the centre between these
/// corners, along periodic axes wrapped, in units of their distance / 65536, `orientation` [n][3]
/// the director in units of 1 / 32767, `speed` |v|, in a uniform flow that beside it, `spin` |w|,
/// and `flow`, `alignment` and `density` are those of needlework view, see picture::values_of; the
/// flow is that along `flow_axis`, along which needles flow most in the last frame. `sizes` are
/// those of the species, which count where needles have none of their own: of several, or of
/// needles that differ, `share_of_length` [n] is the length of each needle shown over that of the
/// longest. Of rods of finite width there is the largest `diameter`, and `share_of_diameter` as
/// well. `walls` are each of one side.
///
/// Frames and needles beyond the limits are left out evenly, the same needles in all frames.
nlohmann::ordered_json frames_of(const std::string& path, const BodySizes& sizes,
                                 std::span<const Scene::Wall> walls, const PageLimits& limits,
                                 Arrays& arrays);

}  // namespace needlework::report
