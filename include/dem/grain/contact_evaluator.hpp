#pragma once

#include <dem/geometry/shape.hpp>
#include <dem/grain/relative_motion.hpp>

#include <span>
#include <vector>

namespace dem::grain {

/// A contact as the narrow phase found it.
struct Hit {
  std::uint64_t key;      ///< of the contact's history
  std::uint32_t i;        ///< row of the grain
  std::uint32_t partner;  ///< row of the other grain, or number of the surface
  std::uint32_t law;      ///< row of the table of contact parameters
};

/// The deepest of a list of contacts: its overlap in effective diameters, and its place in the list.
struct Deepest {
  double overlap = 0.0;
  std::size_t hit = 0;
};

/// Forces of the contacts of a chunk while it is worked on: on i, torques on i and on its partner about their own
/// centres.
struct ContactForces {
  std::array<AlignedVector<double>, 3> force, torque_i, torque_j;

  void make_room(std::size_t n) {
    if (force[0].size() >= n + pack_width) return;
    for (auto* columns : {&force, &torque_i, &torque_j}) {
      for (auto& column : *columns) column.resize(2 * n + pack_width);
    }
  }
  static DEM_HOT_HOST Vector3<double> at(const std::array<AlignedVector<double>, 3>& columns, std::size_t c) {
    return {columns[0][c], columns[1][c], columns[2][c]};
  }
};

/// Evaluates the laws for a list of contacts, a pack at a time, and finds each contact's history by walking along those
/// of the evaluation before: both lists ascend in their keys. What a contact gives does not depend on its neighbours in
/// the pack. `Shape`: whose pairs these are, if they may be patches.
template <class Model, template <class> class ContactPoint, class Shape = void>
class ContactEvaluator {
 public:
  using Histories = HistoriesOfSteps<history_size<Model>>;
  using Parameters = ContactParameters<Model>;

  ContactEvaluator(const std::vector<Parameters>& table, double dt) : table_(table), dt_(dt) { set_uniform(0); }

  /// Fills the contact histories of this evaluation and the forces; contact_point_of(k) gives the raw numbers of
  /// contact k, view_i(k) and view_j(k) its partners. Returns the deepest contact.
  template <class ContactPointOf, class ViewI, class ViewJ>
  Deepest run(std::span<const Hit> hits, Histories& histories, ContactForces& forces, ContactPointOf&& contact_point_of,
              ViewI&& view_i, ViewJ&& view_j) {
    const int count = static_cast<int>(hits.size());
    histories.now.count = count;
    histories.now.make_room(count);
    forces.make_room(hits.size());
    Deepest deepest;
    int cursor = 0;
    PartnerLanes partners;
    for (int at = 0; at < count; at += pack_width) {
      const int lanes = std::min(pack_width, count - at);
      for (int lane = 0; lane < lanes; ++lane) {
        const auto k = static_cast<std::size_t>(at + lane);
        const Hit& hit = hits[k];
        DEM_ASSERT(k == 0 || hits[k - 1].key < hit.key, "contacts ascend in their keys, and each has its own");
        histories.now.key[k] = hit.key;
        scatter(contact_point_of(k), &contact_point_[0][0], lane);
        partners.set(lane, view_i(k), view_j(k));
        law_[lane] = hit.law;
      }
      if constexpr (history_size < Model >> 0) {
        const auto overlap_of = [&](int lane) {
          return contact_point_of(static_cast<std::size_t>(at + lane)).geometry().overlap;
        };
        recall(histories, at, lanes, cursor, overlap_of);
      }
      for (int lane = lanes; lane < pack_width; ++lane) {
        copy_lane(0, lane);
        partners.set(lane, *partners.i[0], *partners.j[0]);
      }
      const Pack overlap = evaluate(relative_motions(partners), histories, forces, static_cast<std::size_t>(at));
      if (any_of(overlap > Pack(deepest.overlap))) [[unlikely]]
        deepest = deepest_of(overlap, lanes, static_cast<std::size_t>(at));
    }
    return deepest;
  }

 private:
  static constexpr std::size_t contact_point_size = contact::field_count<ContactPoint<double>>;

  using PackParameters = ContactParameters<Model, Pack>;

  static Deepest deepest_of(const Pack& overlap, int lanes, std::size_t at) {
    int k = 0;
    for (int other = 1; other < lanes; ++other) k = lane(overlap, other) > lane(overlap, k) ? other : k;
    return {lane(overlap, k), at + static_cast<std::size_t>(k)};
  }

  /// Field k of `value` goes to lane `lane` of row k.
  template <class Value>
  static DEM_HOT_HOST void scatter(const Value& value, double* rows, int lane) {
    constexpr auto size = static_cast<std::size_t>(contact::field_count<Value>);
    const auto fields = std::bit_cast<std::array<double, size>>(value);
    for (std::size_t k = 0; k < size; ++k) rows[k * pack_width + static_cast<std::size_t>(lane)] = fields[k];
  }
  /// A struct of packs from consecutive rows.
  template <class Value>
  static DEM_HOT_HOST Value packed(const double* rows) {
    Value result{};
    if constexpr (!std::is_empty_v<Value>) {
      std::array<Pack, sizeof(Value) / sizeof(Pack)> packs;
      for (std::size_t k = 0; k < packs.size(); ++k) packs[k] = load(rows + k * pack_width);
      result = std::bit_cast<Value>(packs);
    }
    return result;
  }

  /// The histories of the contacts from `at` on go to the lanes; zero where a contact is new. Mostly the contacts of
  /// the evaluation before are there again, in the same order: then whole packs are copied.
  template <class OverlapOf>
  DEM_HOT_HOST void recall(const Histories& histories, int at, int lanes, int& cursor, const OverlapOf& overlap_of) {
    const auto& last = histories.last;
    const std::uint64_t* keys = histories.now.key.data() + at;
    if (lanes == pack_width && cursor + pack_width <= last.count) {
      std::uint64_t differ = 0;
      for (int lane = 0; lane < pack_width; ++lane)
        differ |= keys[lane] ^ last.key[static_cast<std::size_t>(cursor + lane)];
      if (differ == 0) {
        for (std::size_t k = 0; k < last.history.size(); ++k) {
          store(load_unaligned(&last.history[k][static_cast<std::size_t>(cursor)]), history_[k]);
        }
        cursor += pack_width;
        return;
      }
    }
    for (int lane = 0; lane < lanes; ++lane) {
      while (cursor < last.count && last.key[static_cast<std::size_t>(cursor)] < keys[lane]) ++cursor;
      const bool known = cursor < last.count && last.key[static_cast<std::size_t>(cursor)] == keys[lane];
      for (std::size_t k = 0; k < last.history.size(); ++k) {
        history_[k][lane] = known ? last.history[k][static_cast<std::size_t>(cursor)] : 0.0;
      }
      if constexpr (shape::PatchShape<Shape>) {
        if (!known && Shape::is_patch(PairKey{keys[lane]}.feature())) {
          inherit(last, keys[lane], cursor, lane, overlap_of(lane));
        }
      }
      cursor += known ? 1 : 0;
    }
  }
  /// A new point in a patch that touched before starts with a history of its own: of friction and rolling the mean of
  /// what the points of the patch remember; of the normal law what that law makes of the mean (its `inherited()`).
  template <class Last>
  void inherit(const Last& last, std::uint64_t key, int cursor, int lane, double overlap) {
    const auto pair_at = [&](int c) { return PairKey{last.key[static_cast<std::size_t>(c)]}.candidate(); };
    const std::size_t pair = PairKey{key}.candidate();
    int first = cursor, end = cursor;
    while (first > 0 && pair_at(first - 1) == pair) --first;
    while (end < last.count && pair_at(end) == pair) ++end;
    if (first == end) return;
    constexpr std::size_t normal = normal_history_size<Model>;
    constexpr std::size_t to = normal + friction_history_size<Model> + rolling_history_size<Model>;
    for (int c = first; c < end; ++c) {
      for (std::size_t k = 0; k < to; ++k) {
        history_[k][lane] += last.history[k][static_cast<std::size_t>(c)] / (end - first);
      }
    }
    if constexpr (normal > 0) {
      using History = typename Model::Normal::template History<double>;
      std::array<double, normal> fields;
      for (std::size_t k = 0; k < normal; ++k) fields[k] = history_[k][lane];
      const auto own = contact::inherited_by_point<typename Model::Normal>(std::bit_cast<History>(fields), overlap);
      scatter(own, &history_[0][0], lane);
    }
  }
  /// Lanes that no contact fills repeat another, so that they hold ordinary numbers and change nothing.
  void copy_lane(int from, int to) {
    for (auto& row : contact_point_) row[to] = row[from];
    for (auto& row : history_) row[to] = row[from];
    law_[to] = law_[from];
  }

  /// The parameters of each lane's law.
  PackParameters gather_parameters() const {
    PackParameters p{};
    const auto gather = [&](auto& result, auto&& member) {
      using Value = std::remove_reference_t<decltype(result)>;
      if constexpr (!std::is_empty_v<Value>) {
        alignas(64) double rows[sizeof(Value) / sizeof(Pack)][pack_width];
        for (int lane = 0; lane < pack_width; ++lane) scatter(member(table_[law_[lane]]), &rows[0][0], lane);
        result = packed<Value>(&rows[0][0]);
      }
    };
    gather(p.normal, [](const Parameters& q) { return q.normal; });
    gather(p.friction, [](const Parameters& q) { return q.friction; });
    gather(p.rolling, [](const Parameters& q) { return q.rolling; });
    gather(p.cohesion, [](const Parameters& q) { return q.cohesion; });
    return p;
  }
  void set_uniform(std::uint32_t law) {
    for (auto& l : law_) l = law;
    uniform_ = gather_parameters();
    uniform_law_ = law;
  }

  DEM_HOT_HOST Pack evaluate(const RelativeMotion<Pack>& relative, Histories& histories, ContactForces& forces,
                             std::size_t at) {
    bool same = true;
    for (int lane = 0; lane < pack_width; ++lane) same &= law_[lane] == law_[0];
    if (same && law_[0] != uniform_law_) [[unlikely]]
      set_uniform(law_[0]);

    ContactHistory<Model, Pack> history{};
    for_each_history(
        history, [&](auto& h, int row) { h = packed<std::decay_t<decltype(h)>>(&history_[0][0] + row * pack_width); });
    const PackParameters parameters = same ? uniform_ : gather_parameters();
    Pack overlap_ratio;
    const PairWrench<Pack> w = contact_wrench<Model, Pack>(packed<ContactPoint<Pack>>(&contact_point_[0][0]), relative,
                                                           parameters, Pack(dt_), history, overlap_ratio);
    store3(w.force, forces.force, at);
    store3(w.torque_i, forces.torque_i, at);
    store3(w.torque_j, forces.torque_j, at);
    for_each_history(history,
                     [&](const auto& h, int row) { store_history(h, histories, static_cast<std::size_t>(row), at); });
    return overlap_ratio;
  }

  /// Calls f(history, row) for each law's history, where its fields begin at that row of the histories.
  template <class F>
  static DEM_HOT_HOST void for_each_history(ContactHistory<Model, Pack>& h, F&& f) {
    constexpr int friction = normal_history_size<Model>, rolling = friction + friction_history_size<Model>;
    f(h.normal, 0);
    f(h.friction, friction);
    f(h.rolling, rolling);
    f(h.cohesion, rolling + rolling_history_size<Model>);
  }
  template <class History>
  static DEM_HOT_HOST void store_history(const History& h, Histories& histories, std::size_t offset, std::size_t at) {
    if constexpr (!std::is_empty_v<History>) {
      const auto packs = std::bit_cast<std::array<Pack, sizeof(History) / sizeof(Pack)>>(h);
      for (std::size_t k = 0; k < packs.size(); ++k) store(packs[k], &histories.now.history[k + offset][at]);
    }
  }
  static DEM_HOT_HOST void store3(const Vector3<Pack>& v, std::array<AlignedVector<double>, 3>& columns,
                                  std::size_t at) {
    store(v.x, &columns[0][at]);
    store(v.y, &columns[1][at]);
    store(v.z, &columns[2][at]);
  }

  alignas(64) double contact_point_[contact_point_size][pack_width];
  alignas(64) double history_[history_size<Model> > 0 ? history_size<Model> : 1][pack_width];
  std::uint32_t law_[pack_width];
  PackParameters uniform_;
  std::uint32_t uniform_law_ = 0;
  const std::vector<Parameters>& table_;
  double dt_;
};

}  // namespace dem::grain
