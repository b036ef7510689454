#pragma once

#include <dem/geometry/polyhedron/polyhedron_tables.hpp>

#include <cmath>

namespace dem::shape {

/// A point of contact of two polyhedra, in some frame. `of_first` and `of_second` are the elements (face, edge or
/// corner) of the two bodies that meet there.
struct PatchPoint {
  Vector3<double> point;  ///< m, halfway between the two boundaries
  double depth;           ///< m
  double share;           ///< of the contact's stiffness
  std::uint32_t of_first, of_second;
};

/// Corners of one body seen from the frame of another.
struct SeenCorners {
  alignas(64) double x[PolyhedronTables::most_corners], y[PolyhedronTables::most_corners],
      z[PolyhedronTables::most_corners];

  DEM_HOT Vector3<double> operator[](int k) const { return {x[k], y[k], z[k]}; }
};

/// The patch in which a face of one body (the incident one) lies under a face of another (the reference): the incident
/// polygon, cut by the sides of the reference face and by its plane. What is left presses with its mean depth: a corner
/// carries the part of the polygon's area that lies nearest to it as its share, so the shares add up to one. They
/// change continuously as corners come, go, split and merge, hence so do force and torque. A wholly pressed-in face
/// gets the whole stiffness K of the law, an edge (a strip: two corners deep, two at the border) K/2, and a corner (a
/// triangle, one corner deep) K/3, whichever of its faces is looked at.
class FacePatch {
 public:
  FacePatch(const PolyhedronTables& reference, int reference_face, const PolyhedronTables& incident,
            const SeenCorners& seen, int incident_face)
      : reference_(reference), incident_(incident), face_(reference_face), incident_face_(incident_face) {
    for (int s = incident.first_side[index(incident_face)]; s < incident.first_side[index(incident_face + 1)]; ++s) {
      const PolyhedronTables::Side& side = incident.side[index(s)];
      corner_[count_++] = {seen[side.corner],
                           reference.face_element(reference_face),
                           incident.corner_element(side.corner),
                           false,
                           side.edge,
                           false};
    }
    const int first = reference.first_side[index(face_)], sides = reference.first_side[index(face_ + 1)] - first;
    for (int s = 0; s < sides && count_ > 0; ++s) {
      const PolyhedronTables::Side& side = reference.side[index(first + s)];
      cut(side.outward, side.offset, s);
    }
    // The last cut, by the plane itself, leaves points of depth 0 that only close the polygon.
    if (count_ > 0) cut(reference.normal(face_), reference.offset[index(face_)], -1);
  }

  /// Writes the points that lie below the reference plane, in the reference body's frame, reference first. Returns how
  /// many there are.
  int points(PatchPoint* out) const {
    if (count_ < 3) return 0;
    const Vector3<double> normal = reference_.normal(face_);
    // Areas and centroid seen along the normal, relative to a corner; the centroid, unlike the mean of the corners,
    // does not jump when a corner splits in two.
    double total = 0.0;
    Vector3<double> moment = {0, 0, 0};
    const Vector3<double> origin = corner_[0].p;
    for (int k = 2; k < count_; ++k) {
      const Vector3<double> u = corner_[k - 1].p - origin, v = corner_[k].p - origin;
      const double area = dot(normal, cross(u, v));
      total += area;
      moment += area * (u + v);
    }
    if (total == 0.0) return 0;
    const Vector3<double> centre = origin + (1.0 / (3.0 * total)) * moment;
    const auto slice = [&](int k) {
      const int next = k + 1 < count_ ? k + 1 : 0;
      return dot(normal, cross(corner_[k].p - centre, corner_[next].p - centre)) / total;
    };
    int n = 0;
    double before = slice(count_ - 1);
    for (int k = 0; k < count_; ++k) {
      const double after = slice(k);
      const Corner& c = corner_[k];
      const double depth = reference_.offset[index(face_)] - dot(normal, c.p);
      if (!c.on_plane && depth > 0.0) {
        out[n++] = {c.p + (0.5 * depth) * normal, depth, std::abs(0.5 * (before + after)), c.of_reference,
                    c.of_incident};
      }
      before = after;
    }
    return n;
  }

  static constexpr int most_points = 2 * PolyhedronTables::most_corners + 2;

 private:
  struct Corner {
    Vector3<double> p;
    std::uint32_t of_reference, of_incident;
    bool side_of_reference;  ///< which polygon the side that leaves here belongs to
    int side;                ///< number of the side in the reference face, or of the incident edge
    bool on_plane;           ///< made by the reference plane: depth 0
  };
  static std::size_t index(int k) { return static_cast<std::size_t>(k); }

  /// A corner beyond a side by less than this share of the body's radius counts as on it. So the corners of bodies that
  /// are stacked edge on edge touch, although the bodies swing a little.
  static constexpr double slack = 1e-6;

  /// Keeps what lies at outward . p <= offset (Sutherland and Hodgman 1974, DOI 10.1145/360767.360802). `cutter`: the
  /// side of the reference face that cuts, or -1 for its plane.
  void cut(const Vector3<double>& outward, double offset, int cutter) {
    double beyond[most_points];
    bool any = false;
    const double limit = cutter < 0 ? 0.0 : slack * reference_.radius;
    for (int k = 0; k < count_; ++k) {
      beyond[k] = dot(outward, corner_[k].p) - offset;
      any |= beyond[k] > limit;
    }
    if (!any) return;
    Corner kept[most_points];
    int n = 0;
    for (int k = 0; k < count_; ++k) {
      const int next = k + 1 < count_ ? k + 1 : 0;
      const bool in = beyond[k] <= limit, next_in = beyond[next] <= limit;
      if (in) kept[n++] = corner_[k];
      if (in == next_in) continue;
      Corner c = crossing(corner_[k], cutter);
      const double share = std::max(0.0, std::min(1.0, beyond[k] / (beyond[k] - beyond[next])));
      c.p = corner_[k].p + share * (corner_[next].p - corner_[k].p);
      if (in) {
        c.side_of_reference = true;
        c.side = cutter;
      }
      kept[n++] = c;
    }
    count_ = n;
    for (int k = 0; k < n; ++k) corner_[k] = kept[k];
  }

  /// What meets where the side that leaves a corner crosses a cutter: an edge of each body, or a corner of the
  /// reference face and the incident face.
  Corner crossing(const Corner& from, int cutter) const {
    Corner c = from;
    if (cutter < 0) {
      c.on_plane = true;
      return c;
    }
    const int first = reference_.first_side[index(face_)], sides = reference_.first_side[index(face_ + 1)] - first;
    if (from.side_of_reference) {
      const int corner = (cutter + 1) % sides == from.side ? from.side : cutter;
      c.of_reference = reference_.corner_element(reference_.side[index(first + corner)].corner);
      c.of_incident = incident_.face_element(incident_face_);
    } else {
      c.of_reference = reference_.edge_element(reference_.side[index(first + cutter)].edge);
      c.of_incident = incident_.edge_element(from.side);
    }
    return c;
  }

  const PolyhedronTables& reference_;
  const PolyhedronTables& incident_;
  int face_, incident_face_;
  int count_ = 0;
  Corner corner_[most_points];
};

}  // namespace dem::shape
