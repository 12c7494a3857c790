#include "src/io/formats/read_configuration.h"

#include "src/io/formats/dynamo.h"

namespace needlework::io {

bool is_configuration(std::string_view beginning) { return is_dynamo(beginning); }

Configuration read_configuration(const std::string& path) { return read_dynamo(path); }

}  // namespace needlework::io
