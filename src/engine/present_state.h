// The needles of a gas at one time, as callers and files have them.
#pragma once

#include <vector>

#include "kernels/isa.h"
#include "needlework/simulation.h"
#include "needlework/state.h"
#include "src/physics/gas.h"

namespace needlework {

/// How large bodies are: at the start, and now in these sizes.
struct PresentSizes {
  const Composition& at_start;
  double scale;
};

/// Copies all needles but their bodies, in this order, into `out`. The instruction set is used for
/// free flight and affects no bit of the result.
void copy_state(const Gas& gas, Time at, kernels::Isa isa, const std::vector<Needle>& order,
                State& out);
/// Their numbers at these sizes, where the needles of a species differ or bodies grow; otherwise
/// all empty.
void copy_own_bodies(const Gas& gas, const PresentSizes& sizes, const std::vector<Needle>& order,
                     OwnBodies& out);
/// One needle. Throws InputError for an id that does not exist.
FreeNeedle needle_at(const Gas& gas, const PresentSizes& sizes, Time at, Id id);
/// Throws InvalidStateError if needles that fly freely until then have crossed more boxes than are
/// counted.
void require_images(const Gas& gas, Time at);

}  // namespace needlework
