#pragma once

#include <dem/core/type_name.hpp>
#include <dem/math/fingerprint.hpp>
#include <dem/world/contacts.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace dem::soil {

/// A grain of a tile.
struct TileGrain {
  Vector3<double> position;                 ///< m; from the tile's lower corner where the tile repeats itself
  Matrix3<double> rotation;                 ///< grain frame -> global
  Vector3<double> velocity;                 ///< m/s
  Vector3<double> local_angular_velocity;   ///< rad/s, body frame
  std::uint32_t species = 0, reserved = 0;  ///< the number of its species
};

/// Two grains of a tile that touch, the second one `x` and `y` cells away.
struct TileContact {
  std::uint32_t i = 0, j = 0;
  std::int32_t x = 0, y = 0;
  std::uint32_t feature = 0;  ///< says where they touch
};

/// A grain of a tile on a surface.
struct TileSurfaceContact {
  std::uint32_t grain = 0, surface = 0;  ///< surface: number in Tile::surfaces
  std::uint64_t place = 0;               ///< lower part of the contact's key: where they touch
};

/// By what a species of a tile is known again.
struct TileSpecies {
  double mass = 0.0, radius = 0.0;  ///< kg; m, bounding radius
};

/// Grains that came to rest in a cell that repeats itself, with what their contacts remember. Copies of it fit each
/// other without a seam: beds are laid of them (lay_tiles), and a patch of them goes along with a machine
/// (MovingPatch). take_tile makes one, save_tile keeps it in a file.
struct Tile {
  std::array<double, 2> period = {0, 0};  ///< m, along x and y; 0 where it does not repeat itself
  std::vector<TileGrain> grains = {};
  std::vector<TileSpecies> species = {};
  std::vector<std::string> surfaces = {};  ///< names, or "#3" for one without
  std::string shape = {}, laws = {};       ///< types of the model; contacts go on under the same laws only
  std::vector<TileContact> contacts = {};
  std::vector<TileSurfaceContact> on_surfaces = {};
  std::vector<double> histories = {}, surface_histories = {};  ///< of the contacts, one after the other

  double height = 0.0;          ///< m, below which 95 % of the centres lie
  double solid_fraction = 0.0;  ///< between a quarter and three quarters of the height
  double coordination = 0.0;    ///< grains that touch a grain, mean
  Mat3 fabric = Mat3::Zero();   ///< mean of n n^T over the normals of contacts between grains; its trace is 1
  double rms_speed = 0.0;       ///< m/s, of the grains when they were taken out

  template <class V>
  void fields(V& v) {
    v.group("tile", [&] {
      v("period", period, "m"), v("shape", shape), v("laws", laws), v("surfaces", surfaces);
      v.bytes("grains", grains), v.numbers("species", species), v.bytes("contacts", contacts);
      v.bytes("on_surfaces", on_surfaces), v.numbers("histories", histories);
      v.numbers("surface_histories", surface_histories);
      v("height", height, "m"), v("solid_fraction", solid_fraction), v("coordination", coordination);
      v("fabric", fabric), v("rms_speed", rms_speed, "m/s");
    });
  }

  /// Throws Error for a tile whose parts do not belong together.
  void check() const {
    const auto wrong = [](const std::string& why) { fail("this is no tile: {}; make one with take_tile", why); };
    for (const double p : period) {
      if (!(p >= 0.0) || !std::isfinite(p)) wrong(text("its period is {:g} m", p));
    }
    if (!(period[0] + period[1] > 0.0)) wrong("it repeats itself along neither x nor y");
    for (const TileGrain& g : grains) {
      if (g.species >= species.size()) wrong("a grain is of a species that it does not have");
      if (!is_finite(to_eigen(g.position))) wrong("a grain is nowhere");
    }
    const std::size_t n = grains.size();
    for (const TileContact& c : contacts) {
      if (c.i >= n || c.j >= n || std::abs(c.x) > 1 || std::abs(c.y) > 1) wrong("a contact is between no grains of it");
    }
    for (const TileSurfaceContact& c : on_surfaces) {
      if (c.grain >= n || c.surface >= surfaces.size()) wrong("a contact is on a surface that it does not have");
    }
    const auto fit = [](std::size_t numbers, std::size_t of) { return of == 0 ? numbers == 0 : numbers % of == 0; };
    if (!fit(histories.size(), contacts.size()) || !fit(surface_histories.size(), on_surfaces.size()))
      wrong("histories are missing");
  }
  /// 64 bits that tell tiles apart by their grains and what their contacts remember.
  std::uint64_t fingerprint() const {
    std::uint64_t hash = fingerprint_of(period, histories, surface_histories);
    for (const TileGrain& g : grains) {
      mix(hash, fingerprint_of(g.position, g.rotation.row0, g.rotation.row1, g.rotation.row2, g.velocity,
                               g.local_angular_velocity, g.species));
    }
    return hash;
  }
  /// One line: what it is made of.
  std::string in_words() const {
    return text(
        "{} grains, {:g} mm x {:g} mm, {:.1f} mm high, solid fraction {:.4f}, {:.3f} neighbours, fabric {:.3f} "
        "{:.3f} {:.3f}",
        grains.size(), 1e3 * period[0], 1e3 * period[1], 1e3 * height, solid_fraction, coordination, fabric(0, 0),
        fabric(1, 1), fabric(2, 2));
  }
};

/// How a tile is taken out of a world.
struct TileOptions {
  bool stopped = true;  ///< its grains lose what is left of their velocities
};

namespace detail {

/// The numbers that a contact remembers, in the order in which they are stored.
template <class Model>
std::array<double, static_cast<std::size_t>(history_size<Model>)> numbers_of(const ContactHistory<Model, double>& h) {
  std::array<double, static_cast<std::size_t>(history_size<Model>)> numbers;
  auto* to = reinterpret_cast<unsigned char*>(numbers.data());
  const auto add = [&]<class History>(const History& of_law) {
    if constexpr (!std::is_empty_v<History>) {
      std::memcpy(to, &of_law, sizeof(of_law));
      to += sizeof(of_law);
    }
  };
  add(h.normal), add(h.friction), add(h.rolling), add(h.cohesion);
  return numbers;
}

/// The laws whose histories a tile keeps, in words.
template <class Model>
std::string laws_of() {
  std::string laws;
  for (const std::string_view type : {type_name<typename Model::Normal>(), type_name<typename Model::Friction>(),
                                      type_name<typename Model::Rolling>(), type_name<typename Model::Cohesion>()}) {
    laws += (laws.empty() ? "" : "; ") + std::string(type);
  }
  return laws;
}

/// A surface's name, or its number.
template <class Model>
std::string label_of_surface(const WorldState<Model>& w, std::size_t s) {
  return w.surfaces[s].name.empty() ? text("#{}", s) : w.surfaces[s].name;
}

/// Height, density and speed of a tile's grains.
template <class Model>
void measure_tile(Tile& t, const WorldState<Model>& w) {
  std::vector<double> z;
  double speeds = 0.0, low = HUGE_VAL, low_x[2] = {HUGE_VAL, HUGE_VAL}, high_x[2] = {-HUGE_VAL, -HUGE_VAL};
  for (const TileGrain& g : t.grains) {
    const double r = t.species[g.species].radius, at[2] = {g.position.x, g.position.y};
    z.push_back(g.position.z);
    low = std::min(low, g.position.z - r);
    for (int k = 0; k < 2; ++k) low_x[k] = std::min(low_x[k], at[k] - r), high_x[k] = std::max(high_x[k], at[k] + r);
    speeds += dot(g.velocity, g.velocity);
  }
  const auto n = static_cast<double>(z.size());
  t.rms_speed = std::sqrt(speeds / n);
  const auto at = z.begin() + static_cast<std::ptrdiff_t>(0.95 * (n - 1.0));
  std::nth_element(z.begin(), at, z.end());
  t.height = *at - low;
  double area = 1.0, volume = 0.0;
  for (int k = 0; k < 2; ++k) {
    const double period = t.period[static_cast<std::size_t>(k)];
    area *= period > 0.0 ? period : high_x[k] - low_x[k];
  }
  for (const TileGrain& g : t.grains) {
    const double share = (g.position.z - low) / t.height;
    if (share >= 0.25 && share < 0.75) volume += w.species[g.species].shape.volume();
  }
  t.solid_fraction = t.height > 0.0 ? volume / (area * 0.5 * t.height) : 0.0;
}

}  // namespace detail

/// The grains of a world as a tile: of a world that repeats itself along x, y or both, but not along z. Where it does
/// not, its walls belong to the bed: what is laid of the tile needs the same. Contacts with surfaces are known by the
/// names of these. Grains that are held stay held. The world is not changed; it costs a copy of it. Where ranks share
/// the grains, all ranks call it at once, between runs, and each gets the whole tile. Throws Error for an open world or
/// one without grains, and as World::prepare does.
///
///     World<Sand> cell({.domain = surface::Aabb{{0, 0, -1}, {0.1, 0.1, 1}}, .periodic = {.x = true, .y = true}});
///     ...                                            // grains fall and come to rest
///     const soil::Tile tile = soil::take_tile(cell);
template <class Model>
Tile take_tile(const World<Model>& world, const TileOptions& o = {}) {
  static_assert(Model::Domain::has_images && !domain::IsSheared<typename Model::Domain>,
                "a tile is taken out of a world that repeats itself: domain::Periodic");
  require_between_runs(world.state(), "a tile");
  if constexpr (Model::Domain::has_ranks) check_agreement(world.state(), domain::Call::tiles);
  World<Model> copy = world;
  copy.prepare();
  WorldState<Model>& w = copy.state();
  const auto& period = w.domain.period();
  if (period[2] > 0.0) fail("a tile is asked for from a world that repeats itself along z, but a bed has a surface");
  if (copy.grain_count() == 0) fail("a tile is asked for from a world without grains; add some and let them settle");
  rebuild_neighbours(w);  // puts all grains into the cell
  if constexpr (Model::Domain::has_ranks) complete_chunks(w);
  place_images(w);
  const auto& p = w.grains;

  Tile t;
  t.period = {period[0], period[1]};
  t.shape = type_name<typename Model::Shape>();
  t.laws = detail::laws_of<Model>();
  for (const auto& s : w.species) t.species.push_back({s.mass, s.shape.bounding_radius()});
  for (std::size_t s = 0; s < w.surfaces.size(); ++s) t.surfaces.push_back(detail::label_of_surface(w, s));
  const Vector3<double> corner = {w.domain.low(0), w.domain.low(1), 0.0};  // 0 where it does not repeat itself
  t.grains.resize(p.count);
  for (std::size_t k = 0; k < p.count; ++k) {
    t.grains[k] = {p.position[k] - corner, p.rotation(k), p.velocity[k], p.local_angular_velocity[k], p.species[k]};
  }
  detail::measure_tile(t, w);
  if (o.stopped) {
    for (TileGrain& g : t.grains) g.velocity = g.local_angular_velocity = {0, 0, 0};
  }

  const ContactForce* before = nullptr;
  double pairs = 0.0, points = 0.0;
  const auto found = dem::detail::ContactFinder<Model>(w).find();
  for (const auto& c : found) {
    const auto history = detail::numbers_of<Model>(c.last);
    if (c.kind == ContactKind::grain_on_surface) {
      t.on_surfaces.push_back({p.row_of[c.grain.slot], c.surface.value, grain::SurfaceKey{c.point_key}.place()});
      t.surface_histories.insert(t.surface_histories.end(), history.begin(), history.end());
    }
    if (c.kind != ContactKind::grains) continue;
    const std::uint32_t i = p.row_of[c.grain.slot], j = p.row_of[c.other_grain.slot];
    const Vec3 shift = c.other_centre() - to_eigen(p.position[j]);
    const auto cells = [&](double along, double of) {
      return of > 0.0 ? static_cast<std::int32_t>(std::lround(along / of)) : 0;
    };
    t.contacts.push_back(
        {i, j, cells(shift.x(), period[0]), cells(shift.y(), period[1]), grain::PairKey{c.point_key}.feature()});
    t.histories.insert(t.histories.end(), history.begin(), history.end());
    if (c.overlap < 0.0) continue;
    t.fabric += c.normal * c.normal.transpose();
    points += 1.0;
    const bool same = before && before->grain == c.grain && before->other_grain == c.other_grain;  // they come together
    pairs += same ? 0.0 : 1.0;
    before = &c;
  }
  if (points > 0.0) t.fabric /= points;
  t.coordination = 2.0 * pairs / static_cast<double>(p.count);
  return t;
}

}  // namespace dem::soil
