#pragma once

#include <dem/math/vector.hpp>

namespace dem::contact {

// A contact point is what a narrow phase hands to its callback: the raw numbers of one contact, from which `geometry()`
// computes normal, overlap and lever arm for a whole pack of contacts at once. It is a struct of Ts only. All
// vectors are in global axes, seen from the centre of grain i.

/// The contact as the laws need it.
template <class T>
struct Geometry {
  Vector3<T> normal;   ///< unit vector from i towards j
  T overlap;           ///< m
  Vector3<T> arm;      ///< m, from the centre of i to the contact point
  T effective_radius;  ///< m
  T weight;            ///< share of a whole contact, 1 for spheres; or m^2 where points have areas
  /// What the weights of all points of the same patch add up to, where they are shares that may be less than one whole
  /// contact together; else 1. See contact::NormalState::effective_mass.
  T total_share = T(1);
};

/// Two free spheres whose centres are the grains' centres.
template <class T>
struct SphereContactPoint {
  Vector3<T> link;  ///< from sphere i to sphere j
  T radius_i, radius_j;

  DEM_HOT Geometry<T> geometry() const {
    const T distance = max(norm(link), T(1e-300));
    const Vector3<T> normal = (T(1) / distance) * link;
    const T overlap = radius_i + radius_j - distance;
    return {normal, overlap, (radius_i - T(0.5) * overlap) * normal, radius_i * radius_j / (radius_i + radius_j), T(1)};
  }
};

/// Two spheres that belong to clusters.
template <class T>
struct ClusterContactPoint {
  Vector3<T> centre;  ///< of the sphere of i
  Vector3<T> link;    ///< from the sphere of i to the sphere of j
  T radius_i, radius_j;

  DEM_HOT Geometry<T> geometry() const {
    Geometry<T> g = SphereContactPoint<T>{link, radius_i, radius_j}.geometry();
    g.arm += centre;
    return g;
  }
};

/// A contact that the narrow phase knows already as the laws need it: what shapes of any kind can hand over.
template <class T>
struct ContactPoint {
  Vector3<T> normal;     ///< unit vector from i towards j
  T overlap;             ///< m
  Vector3<T> arm;        ///< m, from the centre of i to the contact point
  T effective_radius;    ///< m
  T weight;              ///< as Geometry's: 1 for a whole contact, less for a point of a patch; or m^2
  T total_share = T(1);  ///< as Geometry's

  DEM_HOT Geometry<T> geometry() const { return {normal, overlap, arm, effective_radius, weight, total_share}; }
};

/// How many contacts a shape may have at once where others have one, and their weight in all: the face of a grain whose
/// contacts are points of its surface.
struct Patch {
  double points = 1.0;
  double weight = 1.0;  ///< as the contact points' weights
};

/// The one contact of a grain with a ball, where they share a normal.
struct BallContactPoint {
  Vector3<double> normal;  ///< out of the grain, into the ball
  double overlap;          ///< m
  Vector3<double> point;   ///< m, midway in the overlap, from the grain's centre
};

/// What a grain shows to surfaces: a sphere, or a point of its surface (radius 0).
struct SamplePoint {
  Vector3<double> centre;   ///< m, from the grain's centre, global axes
  double radius;            ///< m
  double effective_radius;  ///< m, of the grain's surface there
  double weight = 1.0;      ///< as Geometry's: of a point the part of the surface that belongs to it; 1 for spheres
};

/// A sample point of a grain and a surface of a machine part.
template <class T>
struct SurfaceContactPoint {
  Vector3<T> centre;  ///< of the sample point
  Vector3<T> normal;  ///< unit vector into the surface
  T radius;           ///< of the sample point
  T gap;              ///< distance from the sample point's centre to the surface along the normal; negative behind it
  T effective_radius;
  T weight;

  DEM_HOT Geometry<T> geometry() const {
    const T overlap = radius - gap;
    return {normal, overlap, centre + (radius - T(0.5) * overlap) * normal, effective_radius, weight};
  }
};

/// A point of a patch on a surface.
template <class T>
struct PatchContactPoint {
  SurfaceContactPoint<T> point;
  T total_share;  ///< as Geometry's

  DEM_HOT Geometry<T> geometry() const {
    Geometry<T> g = point.geometry();
    g.total_share = total_share;
    return g;
  }
};

}  // namespace dem::contact
