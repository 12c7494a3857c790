// What has to be done with the file of a run before a Writer can continue it.
#pragma once

#include <string>

#include "needlework/h5md.h"
#include "src/io/output_file.h"
#include "src/io/source.h"

namespace needlework::io {

/// Throws InputError, "PATH: /OBJECT: reason", unless `source` has all groups and datasets that a
/// Writer of this scene and run makes and no other ones, the same values in those that are written
/// once, and at least the rows of `position` in those that grow.
void require_continuable(const Source& source, const Scene& scene, const RunInfo& run,
                         const Writer::Position& position);

/// Removes all rows from `position` on. A program that is killed in the middle leaves a file in
/// which the rows before `position` are complete, and which this function can shorten again.
void shorten(OutputFile& file, const std::string& place, const Writer::Position& position);

}  // namespace needlework::io
