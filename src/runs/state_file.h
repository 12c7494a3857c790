// The present state of a simulation as a file.
#pragma once

#include <string>

#include "needlework/h5md.h"
#include "needlework/scene.h"
#include "needlework/simulation.h"
#include "needlework/user_data.h"

namespace needlework::runs {

/// What files record of a run besides its scene.
io::RunInfo run_info(const Simulation& simulation, const Scene& scene);

/// Writes a file with one frame and the user's own data, that initial.file of a scene can name. An
/// existing file is replaced if `force` is true, as a whole: a failure leaves what was there.
/// Throws IoError, "PATH: REASON".
void write_state(const Simulation& simulation, const Scene& scene, const UserDataByName& data,
                 const std::string& path, bool force);

}  // namespace needlework::runs
