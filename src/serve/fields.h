// The fields of a request, each with a check of its type.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "needlework/state.h"
#include "src/serve/requests.h"

namespace needlework::serve {

/// All throw RequestError, "FIELD = VALUE: expected ...", for a field of another type.
std::optional<double> number_in(const Json& request, const char* field);
std::optional<std::uint64_t> count_in(const Json& request, const char* field);
std::optional<std::string> text_in(const Json& request, const char* field);
bool flag_in(const Json& request, const char* field);
/// A list of names, each of which is one of those `known`.
std::optional<std::vector<std::string>> names_in(const Json& request, const char* field,
                                                 std::span<const std::string_view> known);
/// Bytes in base64.
std::optional<std::string> bytes_in(const Json& request, const char* field);
/// Arrays in base64, one row for each needle.
std::optional<std::vector<std::array<double, 3>>> vectors_in(const Json& request,
                                                             const char* field);
std::optional<std::vector<std::array<std::int32_t, 3>>> images_in(const Json& request,
                                                                  const char* field);
std::optional<std::vector<std::uint32_t>> ids_in(const Json& request, const char* field);
std::optional<std::vector<std::uint8_t>> species_in(const Json& request, const char* field);
/// An object {name, length, diameter, mass, k} of lists, one entry for each species, which may be
/// missing.
std::optional<Bodies> bodies_in(const Json& request, const char* field);
/// One number for each of `count` pairs: an array in base64, or a number that is that of all.
std::optional<std::vector<double>> numbers_in(const Json& request, const char* field,
                                              std::size_t count);

/// Three numbers.
std::optional<std::array<double, 3>> three_in(const Json& request, const char* field);

/// Throws RequestError for a field that is neither "do" nor "id" nor one of these.
void require_only(const Json& request, std::initializer_list<const char*> fields,
                  std::span<const std::string_view> more = {});

}  // namespace needlework::serve
