#include "src/physics/collisionless.h"

namespace needlework {

const char* words_for(Collisionless reason) {
  switch (reason) {
    case Collisionless::no_needles:
      return "there are no needles";
    case Collisionless::one_needle:
      return "there is one needle";
    case Collisionless::passing:
      return "all needles pass through each other, as pairs.meet = false says";
    case Collisionless::alike:
      return "all needles move alike and do not rotate";
    case Collisionless::parallel:
      return "all needles are parallel and do not rotate";
    case Collisionless::normal_to_x:
      return "all needles lie and move in planes normal to the x axis";
    case Collisionless::normal_to_y:
      return "all needles lie and move in planes normal to the y axis";
    case Collisionless::normal_to_z:
      break;
  }
  return "all needles lie and move in planes normal to the z axis";
}

}  // namespace needlework
