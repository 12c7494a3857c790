// Numbers and vectors in configurations of DynamO.
#include <fmt/format.h>

#include "needlework/error.h"
#include "src/io/formats/dynamo_parts.h"

namespace needlework::io::dynamo {

std::array<double, 3> vector_of(const XmlElement& element) {
  return {element.number("x"), element.number("y"), element.number("z")};
}

std::array<double, 3> read_vector(const XmlElement& parent, const char* name) {
  const XmlElement element = parent.child(name);
  element.require_only({"x", "y", "z"}, {});
  return vector_of(element);
}

double positive_number(const XmlElement& element, const char* attribute) {
  const double value = element.number(attribute);
  if (!(value > 0)) element.reject(attribute, "a number > 0");
  return value;
}

double common_number(const XmlElement& element, const char* attribute) {
  if (!element.has(attribute)) {
    element.reject(fmt::format("{} is missing: expected a number", attribute));
  }
  double value = 0;
  try {
    value = element.number(attribute);
  } catch (const InputError&) {
    element.reject(attribute, "a finite number, the same for all particles");
  }
  return value;
}

double elasticity_of(const XmlElement& element) {
  const double epsilon = common_number(element, "Elasticity");
  if (!(epsilon >= 0 && epsilon <= 1)) element.reject("Elasticity", "a number from 0 to 1");
  return epsilon;
}

}  // namespace needlework::io::dynamo
