// What a new H5MD file holds before the first frame.
#pragma once

#include <string>

#include "needlework/h5md.h"
#include "needlework/scene.h"
#include "src/io/hdf5.h"

namespace needlework::io {

/// Writes the header, the parameters and all datasets, these still without rows, to a new file.
/// `place` begins the messages of errors.
void make_layout(hid_t file, const Scene& scene, const RunInfo& run, const std::string& place);

}  // namespace needlework::io
