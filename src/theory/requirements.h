// Checks of the theory's arguments. All throw std::invalid_argument with a message "NAME = VALUE:
// expected ...".
#pragma once

#include <string_view>

#include "needlework/theory.h"

namespace needlework::theory {

/// Throws unless `holds`. Write the condition so that NaN fails it.
void require(bool holds, std::string_view name, double value, std::string_view expectation);

void require_positive(std::string_view name, double value);      ///< finite, > 0
void require_not_negative(std::string_view name, double value);  ///< finite, >= 0

void require_valid(const Gas& gas);
void require_valid(Temperatures temperatures);

}  // namespace needlework::theory
