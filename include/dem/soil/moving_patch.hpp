#pragma once

#include <dem/soil/height_map.hpp>
#include <dem/soil/lay_tiles.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace dem::soil {

/// A patch of bed that goes along with a machine.
struct PatchOptions {
  int tiles = 8;               ///< along x
  int along_y = 1;             ///< tiles
  Vec3 corner = Vec3::Zero();  ///< m, lower corner at the start
  double rim = 0.0;            ///< m, width of the border whose grains are held; see TileLayout
  double ahead = 0.0;          ///< m, that there is at least of the bed before the place that is followed
  /// m, cells of the height field that is kept of what lies behind; 0: none is kept. It grows with the way, and so does
  /// a file that it is saved in: by 8 bytes times the bed's width over rut_cell^2 a metre, 96 kB for 0.3 m and cells of
  /// 5 mm.
  double rut_cell = 0.0;
};

/// What a reading came to before and after the patch doubled its length.
struct LengthEffect {
  double before = 0.0, after = 0.0;  ///< means
  std::size_t readings_before = 0, readings_after = 0;
  /// The change of the mean, as a share of the one of the longer patch.
  double shift() const { return (after - before) / after; }
};

/// A bed of tiles that goes along +x with a machine: tiles are laid ahead and taken away behind, exactly on their
/// borders, so that it has as many grains after any distance. The machine and all other grains go on in every bit as
/// they were. Grains of the rim at both ends are held: those at the front are laid so and let go when the next tile is
/// laid before them, with what their contacts remember, those behind stand still where they are.
///
/// Where ranks share the grains, every rank has the patch, and all make it follow at once, between runs (not in
/// goes_on() of one).
///
/// Ids of grains that left are given again to those that are laid; so an id is good as long as its grain is in the
/// patch. Grains that left the world for other reasons give theirs too.
///
///     soil::MovingPatch<Sand> patch(world, tile, {.tiles = 8, .rim = 4 * d, .ahead = 0.2});
///     while (...) {
///       if (const StepReport report = world.run_for(1e-3); !report) fail("{}", report.text);
///       patch.follow(world, world.machine().body(wheel).position().x());
///     }
template <class M>
class MovingPatch {
 public:
  using Model = M;

  /// Lays the patch. Throws Error as lay_tiles does, for a world that repeats itself along x, and for a patch that is
  /// too short.
  MovingPatch(World<Model>& world, Tile tile, const PatchOptions& o)
      : tile_(std::move(tile)), options_(o), tiles_(o.tiles), ahead_(o.ahead), end_(o.tiles) {
    tile_.check();
    const double length = tile_.period[0];
    if (!(length > 0.0)) fail("a moving patch goes along x, but its tile does not repeat itself there");
    if (o.tiles < 1 || o.tiles > 1'000'000 || o.along_y < 1) {
      fail("a moving patch has {} x {} tiles, but must have 1 x 1 to 1,000,000", o.tiles, o.along_y);
    }
    require_positive(o.rim, "rim of a moving patch", "m");
    require_non_negative(o.ahead, "bed ahead of a moving patch's machine", "m");
    require_non_negative(o.rut_cell, "cell of a moving patch's rut", "m");
    require_within(o.rim, 0.0, 0.5 * length, "rim of a moving patch, up to half of its tile,");
    if (!(o.tiles * length >= o.ahead + length + o.rim)) {
      fail(
          "a moving patch of {} tiles is {:g} m long, but must be at least {:g} m: what is ahead, a tile, and the rim "
          "behind",
          o.tiles, o.tiles * length, o.ahead + length + o.rim);
    }
    auto layer = layer_in(world);
    if (layer.wraps[0]) fail("a moving patch goes along x, but the world repeats itself there");
    if (o.rut_cell > 0.0) {
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (const TileGrain& g : tile_.grains) {
        low = std::min(low, g.position.y), high = std::max(high, g.position.y);
      }
      if (tile_.period[1] > 0.0) low = 0.0, high = o.along_y * tile_.period[1];
      rut_ = {o.corner.x(),
              o.corner.y() + low,
              o.rut_cell,
              static_cast<std::size_t>(std::max(1.0, std::ceil((high - low) / o.rut_cell - 1e-9))),
              {}};
    }
    world.state().materials.find_range(world.state().largest_radius);
    check_period(world.state());
    change(world, layer, 0);
  }

  /// Lays tiles ahead, and takes as many away behind, when the machine has come so far that less than `ahead` of the
  /// bed lies before `x` (m). To be called between steps, at least once a tile. Returns whether it did. Throws Error if
  /// the machine has run away from the patch.
  bool follow(World<Model>& world, double x) {
    require_between_runs(world.state(), "a bed whose grains come or go");
    const double length = tile_.period[0];
    if (!(x < front()))
      fail(
          "the machine is at x = {:g} m and has run away from the patch, whose front is at {:g} m; follow it more "
          "often",
          x, front());
    int more = 0;
    while (front() + more * length - x < ahead_) ++more;
    if (more == 0) return false;
    if (!world.is_prepared()) world.prepare();
    auto layer = layer_in(world);
    end_ += more;
    const int goes = std::max(0, end_ - begin_ - tiles_);
    take_away(world.state(), layer, goes);
    change(world, layer, more);
    shifts_ += 1;
    return true;
  }

  /// From the next follow() on the patch is twice as long, with twice as much ahead: once. Tiles ahead are laid at
  /// once; behind it grows as the machine goes on. Throws Error when it was asked for before.
  void double_length() {
    if (tiles_ != options_.tiles) fail("a moving patch was asked twice to double its length, but does so once");
    tiles_ *= 2;
    ahead_ *= 2.0;
  }
  bool is_doubled() const { return tiles_ != options_.tiles; }
  /// A reading, such as the pull: its means before and after the patch doubled are compared. While the patch grows,
  /// readings do not count.
  void note(double reading) {
    if (is_doubled() && end_ - begin_ < tiles_) return;
    (is_doubled() ? sum_long_ : sum_short_) += reading;
    (is_doubled() ? effect_.readings_after : effect_.readings_before) += 1;
  }
  /// What doubling changed. Throws Error without readings on both sides.
  LengthEffect length_effect() const {
    LengthEffect e = effect_;
    if (e.readings_before == 0 || e.readings_after == 0)
      fail("there are {} readings of the short patch and {} of the long one, but there must be some of both",
           e.readings_before, e.readings_after);
    e.before = sum_short_ / static_cast<double>(e.readings_before);
    e.after = sum_long_ / static_cast<double>(e.readings_after);
    return e;
  }

  double back() const { return options_.corner.x() + begin_ * tile_.period[0]; }  ///< m
  double front() const { return options_.corner.x() + end_ * tile_.period[0]; }   ///< m
  int tiles() const { return end_ - begin_; }                                     ///< along x, now
  std::uint64_t shifts() const { return shifts_; }                                ///< how often it went on
  /// Grains that lay where a tile had to come, as those that roll far ahead of a wheel, and were taken away for it.
  std::uint64_t strays() const { return strays_; }
  const Tile& tile() const { return tile_; }
  /// The surface that was left behind, from the corner of the first tile to back(); with `world`, all of it.
  const HeightField& rut() const { return rut_; }
  HeightField surface(const World<Model>& world) const {
    HeightField field = rut_;
    const WorldState<Model>& w = world.state();
    if (options_.rut_cell > 0.0) {
      for (std::size_t i = 0; i < w.grains.count; ++i) add_to(field, w, i);
    }
    return field;
  }

  /// For dem::save(world, path, patch): a program makes world and patch as before, and loads both.
  template <class V>
  void fields(V& v) {
    v.group("moving_patch", [&] {
      const std::uint64_t grains = tile_.grains.size();
      v.given("grains_of_the_tile", grains), v.given("tile_along_x", tile_.period[0], "m");
      v.fingerprint("tile", tile_.fingerprint());
      v.given("tiles_at_the_start", options_.tiles), v.given("tiles_along_y", options_.along_y);
      v.given("rim", options_.rim, "m"), v.given("rut_cell", options_.rut_cell, "m");
      v("tiles", tiles_), v("ahead", ahead_, "m"), v("begin", begin_), v("end", end_), v("shifts", shifts_);
      v("strays", strays_);
      v("ids_from", last_.a0), v("ids", last_.id), v("grain_numbers", numbers_), v.bytes("ids_are", last_.is),
          v("rut", rut_);
      v("sum_short", sum_short_), v("sum_long", sum_long_);
      v("readings_before", effect_.readings_before), v("readings_after", effect_.readings_after);
    });
  }

 private:
  using InWorld = detail::InWorld;
  using Layer = detail::TileLayer<Model>;

  Layer layer_in(World<Model>& world) const {
    return detail::layer_of(
        world, tile_,
        {.along_x = options_.tiles, .along_y = options_.along_y, .corner = options_.corner, .rim = options_.rim});
  }

  static void add_to(HeightField& field, const WorldState<Model>& w, std::size_t row) {
    const double volume = w.species[w.grains.species[row]].shape.volume();
    field.add(to_eigen(w.grains.position[row]), std::cbrt(0.75 * volume / std::numbers::pi));
  }

  /// Ids of grains that machine parts hold, in order.
  static std::vector<std::uint32_t> attached(const WorldState<Model>& w) {
    std::vector<std::uint32_t> ids;
    for (const grain::HeldGrains& held : w.held) {
      for (const auto& g : held.grains) ids.push_back(g.id);
    }
    std::sort(ids.begin(), ids.end());
    return ids;
  }
  static void take(WorldState<Model>& w, std::size_t row) {
    w.grains.row_of[w.grains.id[row]] = w.grains.gone;
    w.to_remove.push_back(w.grains.id[row]);
  }

  /// Whether a grain of the tile at the front is still in the world, and no other has its id.
  bool is_there(const WorldState<Model>& w, std::size_t at) const {
    const auto& p = w.grains;
    return last_.is[at] != InWorld::no && p.row_of[last_.id[at]] != p.gone && p.number_of(last_.id[at]) == numbers_[at];
  }

  /// Takes the tiles away that lie behind, and holds the grains of the new rim there.
  void take_away(WorldState<Model>& w, const Layer& layer, int goes) {
    if (goes == 0) return;
    begin_ += goes;
    auto& p = w.grains;
    const auto parts = attached(w);
    const double border = back();
    for (std::size_t i = 0; i < p.count; ++i) {
      const double x = p.position.x[i];
      if (!(x < border + options_.rim) || p.row_of[p.id[i]] == p.gone) continue;
      if (std::binary_search(parts.begin(), parts.end(), p.id[i])) continue;
      if (x < border) {
        if (options_.rut_cell > 0.0) add_to(rut_, w, i);
        take(w, i);
      } else if (p.species[i] < layer.twins.size()) {
        change_species(w, i, layer.twins[p.species[i]]);
      }
    }
  }

  /// Takes the grains away that lie where tiles come: all that reach over the border (m), not above the bed, but for
  /// those of the last tile which are where they were laid.
  void take_strays(WorldState<Model>& w, const Layer& layer, double border) {
    auto& p = w.grains;
    std::vector<std::uint32_t> stays = attached(w);
    double top = -HUGE_VAL;  // m, of the bed
    for (const TileGrain& g : tile_.grains) top = std::max(top, g.position.z + tile_.species[g.species].radius);
    top += options_.corner.z();
    for (int b = 0; b < options_.along_y; ++b) {
      for (std::size_t k = 0; k < tile_.grains.size(); ++k) {
        const std::size_t at = last_.at(last_.a0, b, k);
        if (!is_there(w, at)) continue;
        Vector3<double> moved = p.position[p.row_of[last_.id[at]]] - layer.place(last_.a0, b, k);
        const double across = options_.along_y * tile_.period[1];
        if (layer.wraps[1]) moved.y -= across * std::round(moved.y / across);
        if (norm(moved) <= 0.05 * tile_.species[tile_.grains[k].species].radius) stays.push_back(last_.id[at]);
      }
    }
    std::sort(stays.begin(), stays.end());
    for (std::size_t i = 0; i < p.count; ++i) {
      const double r = w.species[p.species[i]].shape.bounding_radius();
      if (!(p.position.x[i] + r > border && p.position.z[i] - r < top) || p.row_of[p.id[i]] == p.gone) continue;
      if (std::binary_search(stays.begin(), stays.end(), p.id[i])) continue;
      take(w, i);
      ++strays_;
    }
  }

  /// Lays the last `more` tiles, or all of them (0), and lets the rim go that was at the front.
  void change(World<Model>& world, Layer& layer, int more) {
    WorldState<Model>& w = world.state();
    auto& p = w.grains;
    const int first = more == 0 ? begin_ : end_ - more, known = more == 0 ? 0 : 1;
    layer.ground.low[0] = back(), layer.ground.high[0] = front();
    layer.cells[0] = end_ - begin_;
    detail::TileIds ids(first - known, end_ - first + known, 0, options_.along_y, tile_.grains.size());
    if (known > 0) {
      take_strays(w, layer, options_.corner.x() + first * tile_.period[0]);
      for (int b = 0; b < options_.along_y; ++b) {
        for (std::size_t k = 0; k < tile_.grains.size(); ++k) let_go(w, layer, ids, first - 1, b, k);
      }
    }
    const auto asked = [&] {
      return detail::asked_of(tile_, options_.corner, options_.along_y, options_.rim, tiles_, ahead_, begin_, end_,
                              more);
    };
    relist(w, asked, [&](grain::HistoryCarrier<Model>& histories) {
      if (known > 0) {
        histories.forget_gone(p);
        release_ids(w);
      }
      layer.lay(ids, first, end_);
      layer.remember(ids, histories);
    });
    last_ = detail::TileIds(end_ - 1, 1, 0, options_.along_y, tile_.grains.size());
    numbers_.assign(last_.id.size(), 0);
    for (int b = 0; b < options_.along_y; ++b) {
      for (std::size_t k = 0; k < tile_.grains.size(); ++k) {
        const std::size_t from = ids.at(end_ - 1, b, k), to = last_.at(end_ - 1, b, k);
        last_.id[to] = ids.id[from];
        last_.is[to] = ids.is[from] == InWorld::no ? InWorld::no : InWorld::old;
        if (last_.is[to] != InWorld::no) numbers_[to] = p.number_of(last_.id[to]);
      }
    }
  }

  /// A grain of the tile that was the last one: it is free again if the rim held it.
  void let_go(WorldState<Model>& w, const Layer& layer, detail::TileIds& ids, int a, int b, std::size_t k) {
    auto& p = w.grains;
    const std::size_t from = last_.at(a, b, k), to = ids.at(a, b, k);
    if (last_.is[from] == InWorld::no || p.row_of[last_.id[from]] == p.gone) return;
    if (p.number_of(last_.id[from]) != numbers_[from]) return;  // it left, and another grain has its id
    ids.id[to] = last_.id[from];
    ids.is[to] = InWorld::old;
    const std::size_t row = p.row_of[last_.id[from]];
    if (!w.species[p.species[row]].is_held()) return;
    ids.is[to] = InWorld::held;
    const bool stays = layer.ground.in_rim(1, p.position.y[row]) || p.position.x[row] < back() + options_.rim;
    if (!stays) change_species(w, row, SpeciesId(tile_.grains[k].species));
  }

  Tile tile_;
  PatchOptions options_;
  int tiles_;
  double ahead_;
  int begin_ = 0, end_;  // tiles along x, counted from the corner
  std::uint64_t shifts_ = 0, strays_ = 0;
  detail::TileIds last_;                // of the tile at the front
  std::vector<std::uint32_t> numbers_;  // of its grains
  HeightField rut_;
  double sum_short_ = 0.0, sum_long_ = 0.0;
  LengthEffect effect_;
};

}  // namespace dem::soil
