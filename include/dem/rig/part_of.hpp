#pragma once

#include <dem/io/checkpoint/world_columns.hpp>
#include <dem/rig/session.hpp>

#include <string>

namespace dem::rig {

/// A part of a run whose stages are those of worlds of one Model. While it lives, the stages are kept with it.
///
///     PartOf<Sand> part(session, session, "bed");
///     const auto found = session.keep("found", result);
///     make_bed(...);                                     // enters stages
///     session.complete(bed.world);
template <class Model>
class PartOf final : public Part {
 public:
  /// `stages` are those that tell how far the part is: the session, or those of one of several runs side by side.
  PartOf(Session& session, Stages& stages, std::string name) : PartOf(session.parts(), stages, std::move(name)) {}
  /// The same, kept elsewhere.
  PartOf(PartStore& store, Stages& stages, std::string name) : Part(store, std::move(name)), stages_(stages) {
    stages_.set_part(this);
  }
  ~PartOf() override { stages_.set_part(nullptr); }

 private:
  using World = dem::World<Model>;

  void collect(void* world, const void* type, io::StateColumns& columns) const override {
    columns = io::columns_of(checked(world, type));
  }
  void restore_state(void* world, const void* type, io::StateColumns& columns) const override {
    io::restore(checked(world, type), columns);
  }
  static World& checked(void* world, const void* type) {
    if (type != &detail::mark_of<World>) fail("a stage was entered with a world of another model than its part's");
    return *static_cast<World*>(world);
  }

  Stages& stages_;
};

}  // namespace dem::rig
