#pragma once

#include <dem/soil/tile.hpp>
#include <dem/world/relist.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dem::soil::detail {

/// What a grain of a cell is in the world.
enum class InWorld : std::uint8_t {
  no,    ///< it is not there
  old,   ///< it was there, and its contacts are known
  held,  ///< it was held there up to now, so that its contacts with others that were held are not known
  fresh  ///< it is being laid
};

/// Which grain of a world each grain of a range of cells is: cells a0 to a0 + na along x, b0 to b0 + nb along y.
struct TileIds {
  int a0 = 0, na = 0, b0 = 0, nb = 0;
  std::size_t count = 0;  ///< grains in a cell
  std::vector<std::uint32_t> id = {};
  std::vector<InWorld> is = {};

  TileIds() = default;
  TileIds(int first_a, int cells_a, int first_b, int cells_b, std::size_t grains)
      : a0(first_a), na(cells_a), b0(first_b), nb(cells_b), count(grains) {
    const auto n = static_cast<std::size_t>(na) * static_cast<std::size_t>(nb) * count;
    id.assign(n, 0);
    is.assign(n, InWorld::no);
  }
  bool has(int a, int b) const { return a >= a0 && a < a0 + na && b >= b0 && b < b0 + nb; }
  std::size_t at(int a, int b, std::size_t k) const {
    return (static_cast<std::size_t>(b - b0) * static_cast<std::size_t>(na) + static_cast<std::size_t>(a - a0)) *
               count +
           k;
  }
};

/// The ground that a bed of tiles covers, and what is done at its borders.
struct TileGround {
  std::array<double, 2> low = {0, 0}, high = {0, 0};  ///< m
  std::array<bool, 2> is_open = {false, false};       ///< the bed ends there, and neither walls nor images hold it
  double rim = 0.0;                                   ///< m, width of the border whose grains are held; 0: none

  /// Whether a place is in the border along an axis.
  bool in_rim(std::size_t axis, double x) const {
    return is_open[axis] && (x - low[axis] < rim || high[axis] - x < rim);
  }
  bool in_rim(const Vector3<double>& x) const { return in_rim(0, x.x) || in_rim(1, x.y); }
  /// Whether a ball reaches over an open border.
  bool reaches_out(std::size_t axis, double x, double r) const {
    return is_open[axis] && (x - r < low[axis] || x + r > high[axis]);
  }
  bool holds(std::size_t axis, double x) const { return x >= low[axis] && x < high[axis]; }
};

/// Lays cells of a tile in a world, in the middle of a new neighbour list: as grains, then their contacts.
template <class Model>
struct TileLayer {
  WorldState<Model>& w;
  const Tile& tile;
  Vector3<double> corner;  ///< m
  double turn = 0.0;       ///< rad, about z
  TileGround ground;
  std::array<bool, 2> wraps = {};     ///< the world repeats itself there
  std::array<int, 2> cells = {1, 1};  ///< of the bed, for directions in which it does
  std::vector<SpeciesId> twins;       ///< of the tile's species: those of the rim
  std::size_t laid = 0, held = 0, left_out = 0, histories = 0, surface_histories = 0;

  Matrix3<double> rotation() const {
    const double c = std::cos(turn), s = std::sin(turn);
    return {{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
  }
  Vector3<double> place(int a, int b, std::size_t k) const {
    const Vector3<double> x = tile.grains[k].position + Vector3<double>{a * tile.period[0], b * tile.period[1], 0.0};
    return corner + (turn == 0.0 ? x : rotation() * x);
  }

  /// Lays the cells from `from` to `to` (along x) of the range.
  void lay(TileIds& ids, int from, int to) {
    auto& p = w.grains;
    struct New {
      std::uint32_t grain, at, species;
      Vector3<double> x;
    };
    std::vector<New> list;
    list.reserve(static_cast<std::size_t>(to - from) * static_cast<std::size_t>(ids.nb) * tile.grains.size());
    for (int a = from; a < to; ++a) {
      for (int b = ids.b0; b < ids.b0 + ids.nb; ++b) {
        for (std::size_t k = 0; k < tile.grains.size(); ++k) {
          const Vector3<double> x = place(a, b, k);
          if (turn != 0.0 && !(ground.holds(0, x.x) && ground.holds(1, x.y))) continue;
          std::uint32_t kind = tile.grains[k].species;
          const double r = tile.species[kind].radius;
          if (ground.rim > 0.0 && ground.in_rim(x)) {
            held += w.species[kind].is_held() ? 0 : 1;
            kind = twins[kind].value;
          } else if (ground.rim == 0.0 && (ground.reaches_out(0, x.x, r) || ground.reaches_out(1, x.y, r))) {
            ++left_out;
            continue;
          }
          const std::size_t at = ids.at(a, b, k);
          ids.is[at] = InWorld::fresh;
          list.push_back({static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(at), kind, x});
        }
      }
    }
    const std::size_t first = p.count;
    p.resize(first + list.size());
    const Matrix3<double> r = rotation();
    for (std::size_t n = 0; n < list.size(); ++n) {
      const std::size_t row = first + n;
      const TileGrain& g = tile.grains[list[n].grain];
      const bool stands = w.species[list[n].species].is_held();
      p.position.set(row, list[n].x);
      p.set_rotation(row, turn == 0.0 || !Model::Shape::has_orientation ? g.rotation : r * g.rotation);
      p.velocity.set(row, stands ? Vector3<double>{0, 0, 0} : turn == 0.0 ? g.velocity : r * g.velocity);
      p.local_angular_velocity.set(row, stands ? Vector3<double>{0, 0, 0} : g.local_angular_velocity);
      for (Columns3* c : {&p.force, &p.torque}) c->set(row, {0, 0, 0});
      p.set_memory(row, {});
      p.species[row] = list[n].species;
      p.give_id(row);
      ids.id[list[n].at] = p.id[row];
    }
    laid += list.size();
  }

  /// Hands over what the contacts of grains that were laid, or are free again, remember.
  void remember(const TileIds& ids, grain::HistoryCarrier<Model>& carrier) {
    constexpr std::size_t size = static_cast<std::size_t>(history_size<Model>);
    if (size == 0 || tile.laws != laws_of<Model>()) return;
    const auto next = [&](int axis, int c, int by, int low, int n) {  // -1: there is none
      const int to = c + by;
      if (wraps[static_cast<std::size_t>(axis)]) return (to % n + n) % n;
      return to >= low && to < low + n ? to : low - 1;
    };
    const auto is_known = [](InWorld i, InWorld j) {
      return i == InWorld::no || j == InWorld::no ||
             (i != InWorld::fresh && j != InWorld::fresh && !(i == InWorld::held && j == InWorld::held));
    };
    std::vector<int> surface_of;  // of the tile's surfaces, in the world; -1: none
    for (const std::string& name : tile.surfaces) surface_of.push_back(find_surface(name));
    std::size_t cell = 0;
    for (int b = ids.b0; b < ids.b0 + ids.nb; ++b) {
      for (int a = ids.a0; a < ids.a0 + ids.na; ++a) {
        const bool is_told = is_told_here(w, cell++);
        for (std::size_t c = 0; c < tile.contacts.size(); ++c) {
          const TileContact& t = tile.contacts[c];
          const int to_a = next(0, a, t.x, ids.a0, ids.na), to_b = next(1, b, t.y, ids.b0, ids.nb);
          if (!ids.has(to_a, to_b)) continue;
          const std::size_t i = ids.at(a, b, t.i), j = ids.at(to_a, to_b, t.j);
          if (is_known(ids.is[i], ids.is[j])) continue;
          if (is_told) carrier.add_pair(ids.id[i], ids.id[j], t.feature, turned(&tile.histories[c * size]));
          ++histories;
        }
        for (std::size_t c = 0; c < tile.on_surfaces.size(); ++c) {
          const TileSurfaceContact& t = tile.on_surfaces[c];
          const std::size_t i = ids.at(a, b, t.grain);
          const int surface = surface_of[t.surface];
          if (surface < 0 || (ids.is[i] != InWorld::fresh && ids.is[i] != InWorld::held)) continue;
          if (w.species[w.grains.species[w.grains.row_of[ids.id[i]]]].is_held()) continue;  // feels no surface
          const grain::SurfaceKey key = grain::SurfaceKey::at_place(static_cast<std::size_t>(surface), 0, t.place);
          if (is_told) carrier.add_surface(ids.id[i], key, turned(&tile.surface_histories[c * size]));
          ++surface_histories;
        }
      }
    }
  }

  /// The surface of the world that has this name in the tile; -1 if there is none.
  int find_surface(const std::string& name) const {
    for (std::size_t s = 0; s < w.surfaces.size(); ++s) {
      if (label_of_surface(w, s) == name) return static_cast<int>(s);
    }
    return -1;
  }

  /// A history of the tile, in the axes of the world.
  std::array<double, static_cast<std::size_t>(history_size<Model>)> turned(const double* from) const {
    std::array<double, static_cast<std::size_t>(history_size<Model>)> h;
    std::copy_n(from, h.size(), h.begin());
    if (turn == 0.0) return h;
    double* at = h.data() + normal_history_size<Model>;
    turn_history<typename Model::Friction>(at);
    turn_history<typename Model::Rolling>(at + friction_history_size<Model>);
    return h;
  }
  template <class Law>
  void turn_history(double* at) const {
    using History = typename Law::template History<double>;
    if constexpr (!std::is_empty_v<History>) {
      History h;
      std::memcpy(static_cast<void*>(&h), at, sizeof(h));
      const Matrix3<double> r = rotation();
      Law::carry(h, [&](const Vector3<double>& v) { return r * v; });
      std::memcpy(at, &h, sizeof(h));
    }
  }
};

/// 64 bits that tell what is laid: the tile, and numbers that say where.
template <class... Numbers>
std::uint64_t asked_of(const Tile& tile, const Numbers&... where) {
  std::uint64_t hash = fingerprint_of(tile.fingerprint(), tile.laws, tile.surfaces, where...);
  for (const TileContact& c : tile.contacts) mix(hash, fingerprint_of(c.i, c.j, c.x, c.y, c.feature));
  for (const TileSurfaceContact& c : tile.on_surfaces) mix(hash, fingerprint_of(c.grain, c.surface, c.place));
  return hash;
}

/// Throws Error unless a world has the species that a tile's grains are of.
template <class Model>
void check_species(const WorldState<Model>& w, const Tile& tile) {
  tile.check();
  if (tile.shape != type_name<typename Model::Shape>()) {
    fail("a tile of grains of shape {} is to be laid in a world whose grains are of shape {}", tile.shape,
         std::string(type_name<typename Model::Shape>()));
  }
  for (std::size_t k = 0; k < tile.species.size(); ++k) {
    const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); };
    if (k >= w.species.size()) {
      fail("a tile has {} species, but the world {}; add those of the tile first, in their order", tile.species.size(),
           w.species.size());
    }
    const auto& s = w.species[k];
    if (near(s.mass, tile.species[k].mass) && near(s.shape.bounding_radius(), tile.species[k].radius)) continue;
    fail(
        "species {} of a tile has grains of {:g} kg and a bounding radius of {:g} m, but that of the world {:g} kg and "
        "{:g} m; add the tile's species first, in their order",
        k, tile.species[k].mass, tile.species[k].radius, s.mass, s.shape.bounding_radius());
  }
}

}  // namespace dem::soil::detail
