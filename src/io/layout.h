// The groups and datasets of a new H5MD file.
#pragma once

#include <string>

#include "needlework/h5md.h"
#include "needlework/scene.h"
#include "src/io/hdf5.h"

namespace needlework::io {

/// Writes the metadata and the parameters of a run to a new file, and creates all datasets that the
/// run will fill, without rows. `place` begins the messages of errors.
void make_layout(hid_t file, const Scene& scene, const RunInfo& run, const std::string& place);

}  // namespace needlework::io
