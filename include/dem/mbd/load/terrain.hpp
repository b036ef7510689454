#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/mbd/load/load.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// When a terrain is asked for its forces.
struct TerrainStep {
  double time;   ///< s, of the state that the bodies are in
  bool is_kept;  ///< the state is that of a step: what the terrain remembers goes on to it. Else it only answers
  /// Of the way since the state that was kept last, the share that goes with the newest speeds; the rest goes with
  /// those of the evaluation before. 1/2 in the second evaluation of an integrator that has two a step.
  double newest_share = 1.0;
};

/// Ground that remembers, as columns of soil do their ruts and a tyre on a road its stretch: outside of the machine,
/// but part of its state. It is copied and saved with the machine. A class of the user's own may stand beside
/// SoilColumns.
class Terrain {
 public:
  virtual ~Terrain() = default;
  /// A copy with all that it remembers.
  virtual std::unique_ptr<Terrain> copy() const = 0;
  /// Finds the forces on the bodies where they are now, and writes each into the `wrench` of its load: one of those
  /// that were added with terrain_load().
  virtual void evaluate(const std::vector<Body>& bodies, std::vector<Load>& loads, const TerrainStep& step) = 0;
  /// What it is made of, in words that differ where it differs: a saved state is only loaded where they are the same.
  virtual std::string set_up() const = 0;
  /// All that it remembers, in numbers: for a saved state.
  virtual std::vector<double> memory() const = 0;
  /// Takes them back. Throws Error if they are not as many as memory() has.
  virtual void set_memory(const std::vector<double>& numbers) = 0;
  /// What has gone wrong since this was asked last, in words; empty if nothing. It ends the run, and the next one goes
  /// on after it: so each thing is told once.
  virtual std::string take_problem() { return {}; }
  /// What is odd about the newest step, in words, for the notes of reports; empty if nothing.
  virtual std::string note() const { return {}; }
};

/// The force of a terrain on a body, one for each body that it acts on: the terrain writes it before loads are applied.
DEM_SETUP inline LoadSpec terrain_load(std::string name, BodyId body) {
  return {.name = std::move(name), .body = body, .by_terrain = true};
}

/// A terrain of a machine, as a value: copies are deep.
class TerrainPart {
 public:
  /// Throws Error for none.
  TerrainPart(std::string part_name, std::unique_ptr<Terrain> terrain);
  DEM_SETUP TerrainPart(const TerrainPart& other) : name(other.name), terrain_(other.terrain_->copy()) {}
  TerrainPart(TerrainPart&&) noexcept = default;
  DEM_SETUP TerrainPart& operator=(const TerrainPart& other) { return *this = TerrainPart(other); }
  TerrainPart& operator=(TerrainPart&&) noexcept = default;
  ~TerrainPart() = default;

  Terrain& operator*() const { return *terrain_; }
  Terrain* operator->() const { return terrain_.get(); }

  template <class V>
  void fields(V& v) {
    v.given("name", name), v.given("set_up", terrain_->set_up());
    std::vector<double> numbers = terrain_->memory();
    v.numbers("memory", numbers);
    terrain_->set_memory(numbers);
  }

  std::string name;

 private:
  std::unique_ptr<Terrain> terrain_;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE TerrainPart::TerrainPart(std::string part_name, std::unique_ptr<Terrain> terrain)
    : name(std::move(part_name)), terrain_(std::move(terrain)) {
  if (!terrain_) fail("terrain '{}' is none; give one, such as soil columns", name);
}

}  // namespace dem::mbd

#endif
