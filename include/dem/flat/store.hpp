#pragma once

#include <dem/flat/grain_store.hpp>
#include <dem/flat/list_store.hpp>
#include <dem/flat/pair_contact_store.hpp>
#include <dem/flat/refuse.hpp>
#include <dem/flat/surface_contact_store.hpp>

#include <vector>

namespace dem::flat {

/// All that an executor with memory of its own keeps of a world while it runs.
template <class Model>
class Store {
 public:
  GrainStore<Model> grains;
  LawStore<Model> laws;
  ListStore<Model> list;
  PairContactStore<Model> pairs;
  SurfaceContactStore<Model> at_surfaces;

  /// The grains of a world, whose list is made, go to the executor's memory.
  void bring_up(WorldState<Model>& w) {
    check_flat(w);
    grains.bring_up(w);
    laws.bring_up(w);
    surfaces_ = w.surfaces.size();
    list.bring_up(w);
    pairs.bring_up(w, list.chunk_first());
    at_surfaces.bring_up(w);
    totals_.make_room(2);
    summary_.make_room(1);
    // The first chunk speaks for all while the grains are away, as nobody looks at them one by one.
    const double moved2 = w.moved2();
    for (auto& chunk : w.chunks) {
      chunk.moved2 = 0.0;
      chunk.finite = true;
      chunk.deepest = {};
    }
    if (!w.chunks.empty()) w.chunks.front().moved2 = moved2;
    w.executor.reduce("refresh grains", w.grains.count, RefreshGrains<Model>{grains.view(), grains.domain(w)},
                      summary_.data());
    w.executor.wait();
    was_committed_ = false;
    w.executor.set_holds_grains(true);
  }
  /// The grains come back. The world is then as if it had moved them itself.
  void bring_down(WorldState<Model>& w) {
    grains.bring_down(w);
    pairs.bring_down(w, list.chunk_first());
    at_surfaces.bring_down(w);
    w.executor.set_holds_grains(false);
    w.executor.for_each(w.chunks.size(),
                        [&](std::size_t c) { grain::refresh_chunk<Model>(c, w.chunks[c], w.grains, w.species); });
    if (was_committed_) find_deepest(w);
  }

  /// Surfaces go where their bodies are.
  SurfacesView<Model> place_surfaces(WorldState<Model>& w) {
    std::vector<SurfaceView<typename Model::Surfaces>> views;
    for (const auto& s : w.surfaces) views.push_back(view_of(s));
    if (views.size() != surfaces_) laws.bring_up(w), surfaces_ = views.size();
    surface_views_.upload(views.data(), views.size());
    return {surface_views_.data(), views.size()};
  }
  /// What is known of all grains since they were moved.
  void take_summary(WorldState<Model>& w) {
    summary = summary_[0];
    if (!w.chunks.empty()) w.chunks.front().moved2 = summary.moved2;
  }
  /// The contacts of this evaluation become those that the next one starts from.
  void commit() {
    pairs.commit();
    at_surfaces.commit();
    was_committed_ = true;
  }
  /// A stage begins whose contacts are not those that the next evaluation starts from yet.
  void begin_stage() { was_committed_ = false; }

  Summary summary;
  /// Where kernels write it, and the numbers of contacts of pairs and at surfaces.
  Summary* summary_place() { return summary_.data(); }
  std::uint32_t* totals_place() { return totals_.data(); }
  std::uint32_t total(std::size_t k) const { return totals_[k]; }
  /// Bytes of the executor's memory.
  std::size_t bytes() const { return grains.bytes() + list.bytes() + pairs.bytes() + at_surfaces.bytes(); }

 private:
  template <class T>
  using Array = typename Model::Executor::template Array<T>;
  template <class T>
  using Shared = typename Model::Executor::template Shared<T>;

  /// The chunks' deepest contacts in the last evaluation.
  void find_deepest(WorldState<Model>& w) {
    deepest_.make_room(w.chunks.size());
    w.executor.launch("find deepest contacts", w.chunks.size(),
                      FindDeepest<Model>{grains.count(), list.view(), list.first_candidate(), pairs.last().first,
                                         pairs.places().candidate, pairs.results(), at_surfaces.last(),
                                         at_surfaces.results(), deepest_.data()});
    std::vector<DeepestContact> found(w.chunks.size());
    deepest_.download(found.data(), found.size());
    for (std::size_t c = 0; c < found.size(); ++c) w.chunks[c].deepest = found[c];
  }

  std::size_t surfaces_ = 0;
  bool was_committed_ = false;
  Array<SurfaceView<typename Model::Surfaces>> surface_views_;
  Array<DeepestContact> deepest_;
  Shared<std::uint32_t> totals_;
  Shared<Summary> summary_;
};

}  // namespace dem::flat
