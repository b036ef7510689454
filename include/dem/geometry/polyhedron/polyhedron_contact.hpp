#pragma once

#include <dem/geometry/polyhedron/polyhedron_axes.hpp>

#include <algorithm>

namespace dem::shape {

/// Cosine of 0.05 rad, an angle with two uses. Up to it, two faces count as flat on each other. Up to it, a face patch
/// is preferred to a contact of two edges whose common normal is that close to the face's. So a body that lies on
/// another one, tilted by its elastic overlap, does not teeter on single points.
inline constexpr double flat_cosine = 0.99875;

/// The contact of two polyhedra a and b, along the axis of least overlap. Where a face of one presses on the other it
/// is a patch of points (FacePatch). Where two edges cross it is one point, with a corner's share of 1/3. What is found
/// does not depend on which body is called a.
class PolyhedronContact {
 public:
  static constexpr int most_points = FacePatch::most_points;

  /// `turn_a` and `turn_b` are the bodies' rotations, `separation` leads from a's centre to b's, global axes.
  PolyhedronContact(const PolyhedronTables& a, const Matrix3<double>& turn_a, const PolyhedronTables& b,
                    const Matrix3<double>& turn_b, const Vector3<double>& separation)
      : a_(a), b_(b), turn_a_(turn_a), turn_b_(turn_b), separation_(separation) {
    const Matrix3<double> back_a = transposed(turn_a), back_b = transposed(turn_b);
    b_in_a_ = {back_a * turn_b, back_a * separation};
    a_in_b_ = {back_b * turn_a, -(back_b * separation)};
    place_corners(b, b_in_a_, seen_b_);
    if (!test_faces(a, b, seen_b_, of_a_)) return;
    place_corners(a, a_in_b_, seen_a_);
    if (!test_faces(b, a, seen_a_, of_b_)) return;

    // Near edges are enough to find the least overlap of bodies that do overlap, for an edge that decides comes within
    // the overlap of the other body. That they do overlap is proven by a point inside both; without it all edges are
    // asked.
    int near_a[PolyhedronTables::most_edges + 1], near_b[PolyhedronTables::most_edges + 1];
    const double reach = std::min(of_a_.depth, of_b_.depth);
    int count_a = list_near_edges(b, a, of_b_, reach, near_a), count_b = list_near_edges(a, b, of_a_, reach, near_b);
    if (count_a > 0 && count_b > 0 && !test_edges(a, near_a, count_a, b, near_b, count_b, b_in_a_, seen_b_, edges_)) {
      return;
    }
    choose();
    if (proven()) return;
    count_ = 0;
    count_a = list_near_edges(b, a, of_b_, 1e300, near_a);
    count_b = list_near_edges(a, b, of_a_, 1e300, near_b);
    edges_ = EdgeAxis{};
    if (test_edges(a, near_a, count_a, b, near_b, count_b, b_in_a_, seen_b_, edges_)) choose();
  }

  int count() const { return count_; }
  /// Unit vector from a to b, global axes.
  const Vector3<double>& normal() const { return normal_; }
  /// A point from the centre of a, global axes; its elements belong to a and b.
  const PatchPoint& operator[](int k) const { return point_[k]; }
  /// Overlap along the axis of least overlap, m.
  double least_overlap() const { return std::min({of_a_.depth, of_b_.depth, edges_.depth}); }

 private:
  static std::size_t index(int k) { return static_cast<std::size_t>(k); }

  /// The contact along the axis of least overlap.
  void choose() {
    const Vector3<double> out_a = turn_a_ * a_.normal(of_a_.face), out_b = turn_b_ * b_.normal(of_b_.face);
    // Faces that lie flat on each other give the same patch either way; which is the reference is then told by their
    // directions, so that it does not change with every breath, nor when the bodies change their names.
    const Vector3<double> judge = {0.267, 0.535, 0.802};
    const bool flat = -dot(out_a, out_b) > flat_cosine || of_a_.depth == of_b_.depth;
    const bool face_of_a = flat ? dot(judge, out_a) > dot(judge, out_b) : of_a_.depth < of_b_.depth;
    const double face_depth = std::min(of_a_.depth, of_b_.depth);
    const Vector3<double> face_normal = face_of_a ? out_a : -out_b;

    if (edges_.depth < face_depth) {
      const Vector3<double> edge_normal = turn_a_ * edges_.normal;
      if (dot(edge_normal, face_normal) < flat_cosine) {
        set_edges(edge_normal);
        return;
      }
    }
    normal_ = face_normal;
    if (face_of_a) {
      set_patch(a_, of_a_, b_, seen_b_, b_in_a_);
    } else {
      set_patch(b_, of_b_, a_, seen_a_, a_in_b_);
    }
    for (int k = 0; k < count_; ++k) {
      PatchPoint& p = point_[k];
      p.point = face_of_a ? turn_a_ * p.point : turn_b_ * p.point + separation_;
      if (!face_of_a) std::swap(p.of_first, p.of_second);
    }
    std::sort(point_, point_ + count_, [](const PatchPoint& p, const PatchPoint& q) {
      return p.of_first != q.of_first ? p.of_first < q.of_first : p.of_second < q.of_second;
    });
  }

  /// The patch under the best face of `reference`, in its frame. Should rounding leave nothing of it, its deepest
  /// point.
  void set_patch(const PolyhedronTables& reference, const FaceAxes& axes, const PolyhedronTables& incident,
                 const SeenCorners& seen, const Placing& at) {
    // Of the faces around the deepest corner, the one that looks at the reference face.
    const Vector3<double> normal = reference.normal(axes.face), wanted = transpose_times(at.turn, normal);
    const int deepest = axes.deepest(reference, incident);
    int face = -1;
    double most_against = 1e300;
    for (int k = incident.first_fan[index(deepest)]; k < incident.first_fan[index(deepest + 1)]; ++k) {
      const double along = dot(wanted, incident.normal(incident.fan[index(k)]));
      if (along >= most_against) continue;
      most_against = along;
      face = incident.fan[index(k)];
    }
    count_ = FacePatch(reference, axes.face, incident, seen, face).points(point_);
    if (count_ > 0) return;
    count_ = 1;
    point_[0] = {seen[deepest] + (0.5 * axes.depth) * normal, axes.depth, 1.0 / 3.0, reference.face_element(axes.face),
                 incident.corner_element(deepest)};
  }

  /// One point halfway between the points of the two edges that are closest to each other.
  void set_edges(const Vector3<double>& edge_normal) {
    const PolyhedronTables::Edge &ea = a_.edge[index(edges_.of_a)], &eb = b_.edge[index(edges_.of_b)];
    const Vector3<double> p = a_.corner(ea.tail), q = seen_b_[eb.tail], u = a_.corner(ea.head) - p,
                          v = seen_b_[eb.head] - q, w = q - p;
    const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
    const double determinant = uu * vv - uv * uv;
    const auto clamped = [](double x) { return std::max(0.0, std::min(1.0, x)); };
    const double s = clamped((vv * uw - uv * vw) / determinant), t = clamped((uv * uw - uu * vw) / determinant);
    count_ = 1;
    normal_ = edge_normal;
    point_[0] = {turn_a_ * (0.5 * ((p + s * u) + (q + t * v))), edges_.depth, 1.0 / 3.0, a_.edge_element(edges_.of_a),
                 b_.edge_element(edges_.of_b)};
  }

  /// True if the middle of the contact is inside both bodies.
  bool proven() const {
    Vector3<double> middle = {0, 0, 0};
    for (int k = 0; k < count_; ++k) middle += (1.0 / count_) * point_[k].point;
    return inside(a_, transpose_times(turn_a_, middle)) && inside(b_, transpose_times(turn_b_, middle - separation_));
  }
  static bool inside(const PolyhedronTables& x, const Vector3<double>& p) {
    for (int f = 0; f < x.face_lanes; f += pack_width) {
      const auto i = static_cast<std::size_t>(f);
      const Pack height = load(&x.normal_x[i]) * Pack(p.x) + load(&x.normal_y[i]) * Pack(p.y) +
                          load(&x.normal_z[i]) * Pack(p.z) - load(&x.offset[i]);
      if (any_of(height > Pack(0.0))) return false;
    }
    return true;
  }

  const PolyhedronTables& a_;
  const PolyhedronTables& b_;
  const Matrix3<double>& turn_a_;
  const Matrix3<double>& turn_b_;
  Vector3<double> separation_;
  Placing b_in_a_, a_in_b_;
  int count_ = 0;
  Vector3<double> normal_ = {0, 0, 0};
  EdgeAxis edges_;
  PatchPoint point_[most_points];
  SeenCorners seen_a_, seen_b_;
  FaceAxes of_a_, of_b_;
};

}  // namespace dem::shape
