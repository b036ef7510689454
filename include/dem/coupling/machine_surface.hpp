#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/ids.hpp>
#include <dem/geometry/surface_traits.hpp>
#include <dem/grain/partner_view.hpp>
#include <dem/mbd/body/body.hpp>

#include <string>
#include <type_traits>
#include <utility>
#include <variant>

namespace dem {

/// A surface of a machine part, whatever its shape: which body carries it, where, and of what material.
struct SurfaceOnBody {
  DEM_VALUE(SurfaceOnBody)

  std::string name;
  BodyId body;
  MaterialId material;
  Vec3 position = Vec3::Zero();  ///< m, of the surface's frame in the body's frame
  Mat3 rotation = Mat3::Identity();
  bool active = true;  ///< an inactive surface touches nothing

  // Where the surface is now; refreshed from its body before each force evaluation.
  Vector3<double> origin = {0, 0, 0};
  Matrix3<double> axes = Matrix3<double>::identity();
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< m, bounding box in global axes
  bool moved = true;  ///< where it is, or how fast its body goes, is not what it was in the evaluation before
  surface::Aabb swept = {Vec3::Zero(), Vec3::Zero()};  ///< m, around both places where it is and was
  bool has_place = false;                              ///< `place` is known, and nobody moved the body by hand since
  Vector3<double> place = {0, 0, 0};  ///< m, of its origin in the newest evaluation or at the end of the newest step
  double went = 0.0;                  ///< m, the farthest from one of these to the next, within this step
  surface::Aabb went_over = {Vec3::Zero(), Vec3::Zero()};  ///< m, around the places before and after that

  PartnerView view = {};   ///< of the body; one that gives no way has no inverse mass
  PartnerView alone = {};  ///< the same with its own mass, for a partner that gives no way either

  // Sum over all grains of the last force evaluation.
  Vector3<double> force = {0, 0, 0};   ///< N, on the surface
  Vector3<double> torque = {0, 0, 0};  ///< N m, about its body's centre of mass

  Vector3<double> place_on(const Body& b) const { return b.motion.position + b.motion.rotation * from_eigen(position); }
  /// What was moved by hand since the newest step is no way that it went.
  void begin_step(const Body& b);
  /// Notes how far its body went since the newest evaluation.
  void end_step(const Body& b);

 protected:
  /// Goes where its body is; `local` are the bounds of its shape.
  void follow(const Body& b, bool gives_way, const surface::Aabb& local);

 private:
  void note_way(const Vector3<double>& to, const surface::Aabb& over);
};

/// The same with its shape: `Geometry` is the model's variant of surface kinds.
template <class Geometry>
struct MachineSurface : SurfaceOnBody {
  Geometry geometry;

  MachineSurface(SurfaceOnBody where, const Geometry& shape) : SurfaceOnBody(std::move(where)), geometry(shape) {}

  template <class V>
  void fields(V& v) {
    v.given("name", name), v.given("body", body), v.given("material", material);
    v.given("kind", geometry.index()), v.given("position", position, "m"), v.given("rotation", rotation);
    v.fingerprint("shape", std::visit([](const auto& kind) { return surface::fingerprint(kind); }, geometry));
    v("active", active), v("origin", origin, "m"), v("axes", axes), v("low", low, "m"), v("high", high, "m");
    v.reals("view", view), v("force", force, "N"), v("torque", torque, "N m");
  }

  /// Whether another one of the same shape stands at the same place of the same body. Of kinds without a fingerprint()
  /// the bounds tell, which may be those of another shape: so they must have one name as well.
  bool coincides_with(const MachineSurface& other) const {
    if (body != other.body || geometry.index() != other.geometry.index()) return false;
    if (position != other.position || rotation != other.rotation) return false;
    const auto bounds_of = [](const auto& kind) { return kind.bounds(); };
    const surface::Aabb a = std::visit(bounds_of, geometry), b = std::visit(bounds_of, other.geometry);
    if (a.low != b.low || a.high != b.high) return false;  // quickly, as most differ
    if (!std::visit([](const auto& kind) { return surface::TellsFingerprint<std::decay_t<decltype(kind)>>; }, geometry))
      return name == other.name;
    const auto fingerprint_of = [](const auto& kind) { return surface::fingerprint(kind); };
    return std::visit(fingerprint_of, geometry) == std::visit(fingerprint_of, other.geometry);
  }

  /// Goes where its body is. `gives_way`: forces move the body, unless it is fixed.
  void follow(const Body& b, bool gives_way = true) {
    SurfaceOnBody::follow(b, gives_way, std::visit([](const auto& kind) { return kind.bounds(); }, geometry));
  }
};

}  // namespace dem

#if DEM_DEFINES
#include <cstring>

namespace dem {

DEM_DEFINE_VALUE(SurfaceOnBody)

DEM_INLINE void SurfaceOnBody::begin_step(const Body& b) {
  const Vector3<double> off = place_on(b) - place;
  if (dot(off, off) != 0.0) has_place = false;
}

DEM_INLINE void SurfaceOnBody::end_step(const Body& b) {
  const Vector3<double> end = place_on(b);
  const Vec3 shift = to_eigen(end) - to_eigen(origin);
  note_way(end, {low.cwiseMin(Vec3(low + shift)), high.cwiseMax(Vec3(high + shift))});
}

DEM_INLINE void SurfaceOnBody::note_way(const Vector3<double>& to, const surface::Aabb& over) {
  const double way = has_place ? norm(to - place) : 0.0;
  place = to;
  has_place = true;
  if (way > went) went = way, went_over = over;
}

DEM_INLINE void SurfaceOnBody::follow(const Body& b, bool gives_way, const surface::Aabb& local) {
  const PartnerView last_view = view;
  alone = {b.motion.position, 0.0, b.motion.velocity, b.fixed ? 0.0 : 1.0 / b.mass,
           b.motion.rotation * b.motion.angular_velocity};
  view = alone;
  if (!gives_way) view.inverse_mass = 0.0;
  const Vector3<double> last_origin = origin;
  const Matrix3<double> last_axes = axes;
  origin = place_on(b);
  axes = b.motion.rotation * from_eigen(rotation);
  const auto differ = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof(x)) != 0; };
  moved = differ(origin, last_origin) || differ(axes, last_axes) || differ(view.velocity, last_view.velocity) ||
          differ(view.angular_velocity, last_view.angular_velocity);
  // Half sizes along the global axes: |R| times the local half sizes. The origin comes last: added to the middle of
  // a half space, 1e150 m away, it would be lost.
  const Vec3 middle = to_eigen(axes) * (0.5 * (local.low + local.high));
  const Vec3 half = magnitudes(to_eigen(axes)) * (0.5 * (local.high - local.low));
  const surface::Aabb before = {low, high};
  low = to_eigen(origin) + (middle - half);
  high = to_eigen(origin) + (middle + half);
  swept = {low.cwiseMin(before.low), high.cwiseMax(before.high)};
  note_way(origin, swept);
}

}  // namespace dem

#endif
