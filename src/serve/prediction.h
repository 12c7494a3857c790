// First contacts of pairs of needles or rods, for a front end over a pipe.
#pragma once

#include "src/serve/requests.h"

namespace needlework::serve {

/// The answer to a request "predict". Throws RequestError for fields that are not understood, and
/// InputError, "pair N: ...", for a pair that cannot be followed.
Json first_contacts(const Json& request);

}  // namespace needlework::serve
