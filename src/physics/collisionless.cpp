#include "src/physics/collisionless.h"

namespace needlework {

const char* words_for(Collisionless reason) {
  switch (reason) {
    case Collisionless::parallel:
      return "are parallel and do not rotate";
    case Collisionless::normal_to_x:
      return "lie and move in planes normal to the x axis";
    case Collisionless::normal_to_y:
      return "lie and move in planes normal to the y axis";
    case Collisionless::normal_to_z:
      break;
  }
  return "lie and move in planes normal to the z axis";
}

}  // namespace needlework
