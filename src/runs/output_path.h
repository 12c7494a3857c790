// Where a run may write.
#pragma once

#include <string>

#include "needlework/scene.h"

namespace needlework::runs {

/// Throws IoError, "PLACE: REASON", if `file` could not be made there, or exists already and
/// `force` is false. Makes nothing. Asked before a run, so that no computing is wasted on a result
/// that cannot be kept. The place is where the file was named, `option` what the user would give to
/// replace it.
void require_writable(const std::string& file, bool force, const std::string& place,
                      const char* option = "--force");

/// Throws IoError, "PLACE: REASON", if `file` is `input`, by whatever names: force or not, what is
/// read must not be replaced.
void require_other_file(const std::string& file, const std::string& input,
                        const std::string& place);

/// Both for the output file of a scene, if it has one, which is neither `scene_file`, unless that
/// is empty, nor the file of its initial state.
void require_writable_output(const Scene& scene, bool force, const std::string& scene_file,
                             const char* option = "--force");

}  // namespace needlework::runs
