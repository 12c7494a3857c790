#include "needlework/user_data.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "needlework/error.h"
#include "src/scene/printable.h"

namespace needlework {

void require_valid_data(const std::string& name, const UserData& data) {
  if (name.empty() || name.size() > longest_data_name || !is_printable(name)) {
    throw InputError(
        fmt::format("data: name = \"{}\": expected 1 to {} bytes of UTF-8 without control "
                    "characters",
                    printable(name, longest_data_name), longest_data_name));
  }
  if (data.bytes.size() > longest_data) {
    throw InputError(fmt::format("data: {}: {} bytes: expected at most {}", name, data.bytes.size(),
                                 longest_data));
  }
  if (data.kind == UserData::Kind::json && !nlohmann::json::accept(data.bytes)) {
    throw InputError(fmt::format("data: {} = {}: expected JSON in UTF-8", name,
                                 printable(data.bytes, longest_data_name)));
  }
}

}  // namespace needlework
