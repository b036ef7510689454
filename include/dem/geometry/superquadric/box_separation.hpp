#pragma once

#include <dem/math/vector.hpp>

#include <cmath>

namespace dem::shape {

/// How two boxes lie to each other along one direction.
struct BoxSeparation {
  Vector3<double> axis;  ///< unit vector from a to b
  double overlap;        ///< m; negative: the boxes are apart
};

/// Of the 15 directions that can separate two boxes (3 + 3 face normals, 9 products of edges) the one along which they
/// overlap least, in the frame of a; the first that parts them by more than `gap` (m) ends the search. `turn` takes b's
/// frame to a's, `centre` is b's centre, `a` and `b` are half edge lengths (m).
DEM_FN BoxSeparation separate_boxes(const Vector3<double>& a, const Vector3<double>& b, const Matrix3<double>& turn,
                                    const Vector3<double>& centre, double gap = 0.0) {
  using std::abs;
  const Vector3<double> rows[3] = {turn.row0, turn.row1, turn.row2};
  const double c[3] = {centre.x, centre.y, centre.z};
  const double ha[3] = {a.x, a.y, a.z}, hb[3] = {b.x, b.y, b.z};
  double r[3][3], m[3][3];  // entries of the rotation, and their magnitudes
  for (int i = 0; i < 3; ++i) {
    const double row[3] = {rows[i].x, rows[i].y, rows[i].z};
    for (int j = 0; j < 3; ++j) {
      r[i][j] = row[j];
      m[i][j] = abs(row[j]);
    }
  }

  BoxSeparation best = {{1, 0, 0}, 1e300};
  const auto consider = [&](const Vector3<double>& axis, double distance, double reach, double bonus) {
    const double overlap = reach - abs(distance);
    if (overlap + bonus < best.overlap) best = {distance < 0.0 ? -axis : axis, overlap};
    return overlap < -gap;
  };
  for (int i = 0; i < 3; ++i) {
    const Vector3<double> axis = {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
    if (consider(axis, c[i], ha[i] + hb[0] * m[i][0] + hb[1] * m[i][1] + hb[2] * m[i][2], 0.0)) return best;
  }
  for (int j = 0; j < 3; ++j) {
    const Vector3<double> axis = {r[0][j], r[1][j], r[2][j]};
    const double distance = c[0] * r[0][j] + c[1] * r[1][j] + c[2] * r[2][j];
    if (consider(axis, distance, hb[j] + ha[0] * m[0][j] + ha[1] * m[1][j] + ha[2] * m[2][j], 0.0)) return best;
  }
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const double length = std::sqrt(r[i1][j] * r[i1][j] + r[i2][j] * r[i2][j]);
      if (length < 1e-6) continue;  // edges are parallel: their product says no more than the faces
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double scale = 1.0 / length;
      double axis[3] = {};
      axis[i1] = -scale * r[i2][j];
      axis[i2] = scale * r[i1][j];
      const double distance = axis[i1] * c[i1] + axis[i2] * c[i2];
      const double reach = scale * (ha[i1] * m[i2][j] + ha[i2] * m[i1][j] + hb[j1] * m[i][j2] + hb[j2] * m[i][j1]);
      // A whisker in favour of faces keeps the choice steady where both directions say the same.
      if (consider({axis[0], axis[1], axis[2]}, distance, reach, 1e-9 * (ha[i] + hb[j]))) return best;
    }
  }
  return best;
}

}  // namespace dem::shape
