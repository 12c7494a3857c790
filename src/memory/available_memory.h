// How much memory the process can expect to get.
#pragma once

namespace needlework {

/// Memory that the process can expect to get [bytes]: what the machine has available, or the limit
/// of its control group if that is less. Infinity where neither is known.
double available_memory();

}  // namespace needlework
