#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/mesh/mesh_topology.hpp>

#include <cmath>
#include <numbers>
#include <utility>

namespace dem {

/// Which way the triangles of a closed mesh shall look.
enum class MeshFacing {
  outward,  ///< away from the enclosed volume: a solid
  inward,   ///< into the enclosed volume: a cavity, e.g. a drum seen from inside; what stands in it looks outward
  as_given  ///< only made consistent
};

namespace detail {

inline bool runs(const std::array<std::uint32_t, 3>& t, std::uint32_t from, std::uint32_t to) {
  return (t[0] == from && t[1] == to) || (t[1] == from && t[2] == to) || (t[2] == from && t[0] == to);
}

/// Six times the volume between a triangle and a point.
DEM_LAZY double spanned(const IndexedMesh& mesh, std::uint32_t t, const Vec3& from);

/// How many times a closed piece goes round a point, as solid angles: 0 outside, 1 or -1 inside, something between on
/// the surface (van Oosterom and Strackee 1983, doi:10.1109/TBME.1983.325207). Nothing hangs on a ray that meets an
/// edge.
DEM_LAZY double winding_number(const IndexedMesh& mesh, const std::vector<std::uint32_t>& piece, const Vec3& point);

/// Whether closed piece b, which does not cross closed piece a, lies in it. Pieces may touch, so the middle of the
/// first triangle of b that does not lie on a decides.
DEM_LAZY bool encloses(const IndexedMesh& mesh, const std::vector<std::uint32_t>& a,
                       const std::vector<std::uint32_t>& b);

/// Whether none of closed piece b lies outside of closed piece a, by the middles of some of its triangles.
DEM_LAZY bool encloses_all(const IndexedMesh& mesh, const std::vector<std::uint32_t>& a,
                           const std::vector<std::uint32_t>& b);

/// Makes neighbours look the same way, piece by piece: the smaller part of a piece is turned round. Then a closed piece
/// that lies in no other one is made to look as asked. What lies in a solid is turned with it, so a hollow stays one.
/// What stands in a cavity is a solid, what lies in that a cavity, and so on, whichever way they looked. Returns how
/// many triangles were turned, and how many pieces there are. A piece whose box lies in another's costs a sum over that
/// one's triangles, of 0.1 us each (8 s for 1,000 pieces in a hull of 80,000); MeshFacing::as_given asks for none.
DEM_LAZY std::pair<std::size_t, std::size_t> orient(IndexedMesh& mesh, MeshFacing facing);

}  // namespace detail

}  // namespace dem

#if DEM_DEFINES

namespace dem::detail {

DEM_LAZY_INLINE double spanned(const IndexedMesh& mesh, std::uint32_t t, const Vec3& from) {
  return (mesh.corner(t, 0) - from).dot(cross(mesh.corner(t, 1) - from, mesh.corner(t, 2) - from));
}

DEM_LAZY_INLINE double winding_number(const IndexedMesh& mesh, const std::vector<std::uint32_t>& piece,
                                      const Vec3& point) {
  double sum = 0.0;
  for (const std::uint32_t t : piece) {
    const Vec3 a = mesh.corner(t, 0) - point, b = mesh.corner(t, 1) - point, c = mesh.corner(t, 2) - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm(), volume = a.dot(cross(b, c));
    if (std::abs(volume) <= 1e-12 * la * lb * lc) continue;  // seen edge on, or the point lies on it
    sum += std::atan2(volume, la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * std::numbers::pi);
}

DEM_LAZY_INLINE bool encloses(const IndexedMesh& mesh, const std::vector<std::uint32_t>& a,
                              const std::vector<std::uint32_t>& b) {
  for (const std::uint32_t t : b) {
    const Vec3 middle = (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3.0;
    const double turns = winding_number(mesh, a, middle);
    if (std::abs(turns - std::round(turns)) < 1e-3) return std::round(turns) != 0.0;
  }
  return false;
}

DEM_LAZY_INLINE bool encloses_all(const IndexedMesh& mesh, const std::vector<std::uint32_t>& a,
                                  const std::vector<std::uint32_t>& b) {
  for (std::size_t k = 0; k < b.size(); k += 1 + b.size() / 64) {
    const Vec3 middle = (mesh.corner(b[k], 0) + mesh.corner(b[k], 1) + mesh.corner(b[k], 2)) / 3.0;
    if (std::abs(winding_number(mesh, a, middle)) < 1e-3) return false;
  }
  return true;
}

DEM_LAZY_INLINE std::pair<std::size_t, std::size_t> orient(IndexedMesh& mesh, MeshFacing facing) {
  const MeshTopology topology = topology_of(mesh);
  const std::size_t n = mesh.triangles.size();
  std::vector<std::uint32_t> piece(n, MeshTopology::none);
  std::vector<std::vector<std::uint32_t>> pieces;
  std::vector<char> turned(n, 0);
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    if (piece[seed] != MeshTopology::none) continue;
    std::vector<std::uint32_t> members = {seed};
    piece[seed] = static_cast<std::uint32_t>(pieces.size());
    std::size_t turns = 0;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const std::uint32_t t = members[k];
      for (std::size_t e = 0; e < 3; ++e) {
        const std::uint32_t other = topology.neighbour[t][e];
        if (other == MeshTopology::none || piece[other] != MeshTopology::none) continue;
        piece[other] = piece[seed];
        const bool same = runs(mesh.triangles[other], mesh.triangles[t][e], mesh.triangles[t][(e + 1) % 3]);
        turned[other] = turned[t] != same;
        turns += turned[other] != 0;
        members.push_back(other);
      }
    }
    if (2 * turns > members.size()) {
      for (const std::uint32_t t : members) turned[t] = turned[t] == 0;
    }
    pieces.push_back(std::move(members));
  }
  const std::vector<std::array<std::uint32_t, 3>> given = mesh.triangles;
  for (std::size_t t = 0; t < n; ++t) {
    if (turned[t] != 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  if (facing != MeshFacing::as_given && topology.closed()) {
    std::vector<std::pair<Vec3, Vec3>> boxes;
    std::vector<double> volume;
    for (const auto& members : pieces) {
      Vec3 low = mesh.corner(members[0], 0), high = low;
      double sum = 0.0;
      for (const std::uint32_t t : members) {
        for (int k = 0; k < 3; ++k) {
          low = lower(low, mesh.corner(t, k));
          high = upper(high, mesh.corner(t, k));
        }
        sum += spanned(mesh, t, mesh.vertices[0]);
      }
      boxes.emplace_back(low, high);
      volume.push_back(sum);
    }
    const auto holds = [&](std::size_t a, std::size_t b) {
      return a != b && none_below(boxes[b].first, boxes[a].first) && none_below(boxes[a].second, boxes[b].second) &&
             encloses(mesh, pieces[a], pieces[b]);
    };
    const auto turn = [&](std::size_t k) {
      for (const std::uint32_t t : pieces[k]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    };
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      std::size_t around = 0;  // pieces in which it lies, whole where these tell which way it looks
      for (std::size_t outer = 0; outer < pieces.size(); ++outer) {
        around +=
            holds(outer, k) && (facing != MeshFacing::inward || encloses_all(mesh, pieces[outer], pieces[k])) ? 1 : 0;
      }
      if (facing == MeshFacing::inward) {
        if ((around % 2 == 0) == (volume[k] > 0.0)) turn(k);
      } else if (around == 0 && volume[k] < 0.0) {
        turn(k);
        for (std::size_t inner = 0; inner < pieces.size(); ++inner) {
          if (holds(k, inner)) turn(inner);
        }
      }
    }
  }
  std::size_t flipped = 0;
  for (std::size_t t = 0; t < n; ++t) flipped += given[t] != mesh.triangles[t];
  return {flipped, pieces.size()};
}

}  // namespace dem::detail

#endif
