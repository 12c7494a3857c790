// A front end over a pipe: one JSON object a line in, one a line out.
#pragma once

#include <iosfwd>

namespace needlework::serve {

/// Answers the requests of `in`, one for each line and in their order, until "quit" or the end of
/// the input. A line that is not understood is answered by an error, too. The calling thread reads,
/// so that "interrupt" acts on what is running; another one computes. Throws IoError if an answer
/// cannot be written.
void serve(std::istream& in, std::ostream& out);

}  // namespace needlework::serve
