// The checkpoint from which a run goes on, made ready for this machine.
#pragma once

#include <functional>
#include <string>

#include "needlework/scene.h"
#include "src/runs/checkpoint.h"

namespace needlework::runs {

/// Reads the last checkpoint of the run that this output file holds. Its scene names this file,
/// which may have been moved, and has the engine that choose_engine() finds here, which may be
/// another machine: the instruction set of before does not count. `change` may set ends and engine
/// before the choice. Throws what CheckpointFiles::latest() and choose_engine() throw.
CheckpointFiles::Latest load_checkpoint(const std::string& output_file,
                                        const std::function<void(Scene&)>& change = {});

/// Two warnings as one, of which either may be empty.
std::string joined(const std::string& first, const std::string& second);

}  // namespace needlework::runs
