#pragma once

#include <dem/core/macros.hpp>

#include <initializer_list>

namespace dem::mbd {

/// A degree of freedom of a joint, seen from body a: how far b's point has moved along an axis of a's joint frame, or
/// how b has turned. Its value is the joint's coordinate.
enum class Dof {
  own,      ///< the rotation of joints that turn about z, the displacement of those that slide along z, or the length
  turn,     ///< rad, about z, over whole turns
  slide,    ///< m, along z
  slide_x,  ///< m
  slide_y,  ///< m
  length,   ///< m, between the points of a distance joint; it is held, so it can only be read
  bend,     ///< rad, angle between the two z axes, 0 to pi
  bend_x,   ///< rad, of a universal joint: about x of body a, the arm of its cross on a
  bend_y    ///< rad, of a universal joint: about y of body b, the arm of its cross on b
};

const char* name_of(Dof dof);
constexpr bool is_rotation(Dof f) { return f == Dof::turn || f >= Dof::bend; }

/// A few degrees of freedom.
class Dofs {
 public:
  constexpr Dofs() = default;
  constexpr Dofs(std::initializer_list<Dof> list) {
    for (const Dof f : list) list_[count_++] = f;
  }
  constexpr const Dof* begin() const { return list_; }
  constexpr const Dof* end() const { return list_ + count_; }
  constexpr bool has(Dof dof) const {
    for (const Dof f : *this) {
      if (f == dof) return true;
    }
    return false;
  }

 private:
  Dof list_[8] = {};
  int count_ = 0;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE const char* name_of(Dof dof) {
  constexpr const char* names[] = {"coordinate", "turn", "slide",  "slide_x", "slide_y",
                                   "length",     "bend", "bend_x", "bend_y"};
  return names[static_cast<int>(dof)];
}

}  // namespace dem::mbd

#endif
