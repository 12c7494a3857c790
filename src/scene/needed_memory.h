// How much memory a run of a scene will need, and whether that is available.
#pragma once

#include <string>

#include "needlework/scene.h"

namespace needlework {

/// Memory of a run of this scene at its peak [bytes].
double estimated_memory(const Scene& scene);

/// Throws InputError naming needles.count if the run needs more memory than there is.
void require_memory(const Scene& scene);

/// Bytes such as "12.5 MB".
std::string bytes_text(double bytes);

}  // namespace needlework
