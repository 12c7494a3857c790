// A user's own data, by C callers.
#include <cstring>
#include <iterator>
#include <optional>
#include <string>

#include "needlework/error.h"
#include "src/c/handle.h"

using namespace needlework;

static_assert(static_cast<int>(UserData::Kind::bytes) == NEEDLEWORK_DATA_BYTES);
static_assert(static_cast<int>(UserData::Kind::json) == NEEDLEWORK_DATA_JSON);

int needlework_set_data(needlework_simulation* simulation, const char* name, int kind,
                        const void* data, size_t size) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(name, "name");
    if (kind != NEEDLEWORK_DATA_BYTES && kind != NEEDLEWORK_DATA_JSON) {
      throw c::UsageError("kind = " + std::to_string(kind) +
                          ": expected NEEDLEWORK_DATA_BYTES or NEEDLEWORK_DATA_JSON");
    }
    // Before a copy is made: a size that is wrong must not fill the memory.
    if (size > longest_data) {
      throw c::UsageError("size = " + std::to_string(size) + ": expected at most " +
                          std::to_string(longest_data));
    }
    std::optional<UserData> value;
    if (data) {
      value = {static_cast<UserData::Kind>(kind),
               std::string(static_cast<const char*>(data), size)};
    }
    try {
      self.run.set_data(name, std::move(value));
    } catch (const InputError& error) {
      throw c::UsageError(error.what());
    }
  });
}

int needlework_get_data(needlework_simulation* simulation, const char* name, int* kind, void* data,
                        size_t capacity, size_t* size) {
  return c::guarded(simulation, [&](needlework_simulation& self) {
    c::require(name, "name");
    const auto found = self.run.data().find(name);
    if (found == self.run.data().end()) {
      throw c::UsageError("name = \"" + std::string(name) +
                          "\": expected one of needlework_data_name()");
    }
    const auto& [its_kind, bytes] = found->second;
    if (kind) *kind = static_cast<int>(its_kind);
    if (size) *size = bytes.size();
    if (!data) return;
    if (bytes.size() > capacity) {
      throw c::UsageError("capacity = " + std::to_string(capacity) + ": expected at least " +
                          std::to_string(bytes.size()));
    }
    std::memcpy(data, bytes.data(), bytes.size());
  });
}

const char* needlework_data_name(needlework_simulation* simulation, size_t index) {
  const char* name = nullptr;
  c::guarded(simulation, [&](needlework_simulation& self) {
    const UserDataByName& data = self.run.data();
    if (index < data.size()) {
      name = std::next(data.begin(), static_cast<std::ptrdiff_t>(index))->first.c_str();
    }
  });
  return name;
}
