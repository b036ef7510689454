#pragma once

#include <dem/contact/touch.hpp>
#include <dem/state/contacts.hpp>
#include <dem/state/materials.hpp>

#include <span>
#include <vector>

namespace dem::pipeline {

/// Motion of the two partners of a contact relative to each other, global axes.
template <class T>
struct Encounter {
  Vector3<T> separation;      ///< m, from the centre of i to the centre of j
  Vector3<T> velocity;        ///< m/s, of the centre of i minus that of j
  Vector3<T> spin_i, spin_j;  ///< rad/s
  T inverse_mass;             ///< 1/kg, 1/mi + 1/mj
};

template <class T>
struct Wrench {
  Vector3<T> force;               ///< N, on i; the partner feels the opposite
  Vector3<T> torque_i, torque_j;  ///< N m, each about its own centre
};

/// The laws applied to one contact (T = double) or to a pack of contacts: eqs. 20-30. Updates the history and returns
/// the wrench and, in `overlap_ratio`, the overlap in effective diameters.
template <class Model, class T, class Touch>
DEM_HOT Wrench<T> contact_wrench(const Touch& touch, const Encounter<T>& e,
                                 const typename Model::Normal::template Parameters<T>& normal_parameters,
                                 const typename Model::Friction::template Parameters<T>& friction_parameters, T dt,
                                 ContactHistory<Model, T>& history, T& overlap_ratio) {
  const contact::Geometry<T> g = touch.geometry();
  const Vector3<T> arm_j = g.arm - e.separation;
  const Vector3<T> velocity = e.velocity + cross(e.spin_i, g.arm) - cross(e.spin_j, arm_j);
  const T approach = dot(velocity, g.normal);
  const Vector3<T> sliding = velocity - approach * g.normal;
  const T mass = T(1) / e.inverse_mass;

  const T normal_force = Model::Normal::force(
      normal_parameters, contact::NormalState<T>{g.overlap, approach, g.area, g.effective_radius, mass, dt},
      history.normal);

  // The history's vectors follow the contact: they turn with the mean twist of the partners about the normal and stay
  // in the tangent plane.
  const T twist = T(0.5) * dt * dot(e.spin_i + e.spin_j, g.normal);
  Model::Friction::carry(history.friction, [&](const Vector3<T>& v) {
    return v + twist * cross(g.normal, v) - dot(g.normal, v) * g.normal;
  });
  const Vector3<T> friction = Model::Friction::force(
      friction_parameters,
      contact::TangentialState<T>{sliding, normal_force, g.overlap, g.area, g.effective_radius, mass, dt},
      history.friction);

  const Vector3<T> force = friction - normal_force * g.normal;
  overlap_ratio = T(0.5) * g.overlap / g.effective_radius;
  return {force, cross(g.arm, force), -cross(arm_j, force)};
}

/// A contact as the narrow phase found it.
struct Hit {
  std::uint64_t key;      ///< of the contact's memory
  std::uint32_t i;        ///< row of the grain
  std::uint32_t partner;  ///< row of the other grain, or number of the surface
  std::uint32_t law;      ///< row of the table of contact parameters
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
  static DEM_HOT Vector3<double> at(const std::array<AlignedVector<double>, 3>& columns, std::size_t c) {
    return {columns[0][c], columns[1][c], columns[2][c]};
  }
};

/// Evaluates the laws for a list of contacts, a pack at a time, and finds each contact's memory by walking along last
/// step's in step: both lists ascend in their keys. What a contact gives does not depend on its neighbours in the pack.
template <class Model, template <class> class Touch>
class ContactEvaluator {
 public:
  using Memories = ContactMemories<history_size<Model>>;
  using Parameters = ContactParameters<Model>;

  ContactEvaluator(const std::vector<Parameters>& table, double dt) : table_(table), dt_(dt) { set_uniform(0); }

  /// Fills this step's memories and the forces; touch_of(k) gives the raw numbers of contact k and encounter_of(k) the
  /// partners' relative motion. Returns the largest overlap in effective diameters.
  template <class TouchOf, class EncounterOf>
  double run(std::span<const Hit> hits, Memories& memories, ContactForces& forces, TouchOf&& touch_of,
             EncounterOf&& encounter_of) {
    const int count = static_cast<int>(hits.size());
    memories.now.count = count;
    memories.make_room(count);
    forces.make_room(hits.size());
    Pack worst(0.0);
    int cursor = 0;
    for (int at = 0; at < count; at += pack_width) {
      const int lanes = std::min(pack_width, count - at);
      for (int lane = 0; lane < lanes; ++lane) {
        const auto k = static_cast<std::size_t>(at + lane);
        const Hit& hit = hits[k];
        memories.now.key[k] = hit.key;
        scatter(touch_of(k), &touch_[0][0], lane);
        scatter(encounter_of(k), &encounter_[0][0], lane);
        law_[lane] = hit.law;
        if constexpr (history_size < Model >> 0) recall(memories.last, hit.key, cursor, lane);
      }
      for (int lane = lanes; lane < pack_width; ++lane) copy_lane(0, lane);
      worst = max(worst, evaluate(memories, forces, static_cast<std::size_t>(at)));
    }
    return largest(worst);
  }

 private:
  static constexpr int touch_size = contact::field_count<Touch<double>>;
  static constexpr int encounter_size = contact::field_count<Encounter<double>>;

  struct PackParameters {
    typename Model::Normal::template Parameters<Pack> normal;
    typename Model::Friction::template Parameters<Pack> friction;
  };

  /// Field k of `value` goes to lane `lane` of row k.
  template <class Value>
  static DEM_HOT void scatter(const Value& value, double* rows, int lane) {
    constexpr auto size = static_cast<std::size_t>(contact::field_count<Value>);
    const auto fields = std::bit_cast<std::array<double, size>>(value);
    for (std::size_t k = 0; k < size; ++k) rows[k * pack_width + static_cast<std::size_t>(lane)] = fields[k];
  }
  /// A struct of packs from consecutive rows.
  template <class Value>
  static DEM_HOT Value packed(const double* rows) {
    Value result{};
    if constexpr (!std::is_empty_v<Value>) {
      std::array<Pack, sizeof(Value) / sizeof(Pack)> packs;
      for (std::size_t k = 0; k < packs.size(); ++k) packs[k] = load(rows + k * pack_width);
      result = std::bit_cast<Value>(packs);
    }
    return result;
  }

  /// The contact's history goes to a lane; zero if it is new.
  template <class Memory>
  DEM_HOT void recall(const Memory& last, std::uint64_t key, int& cursor, int lane) {
    while (cursor < last.count && last.key[static_cast<std::size_t>(cursor)] < key) ++cursor;
    const bool known = cursor < last.count && last.key[static_cast<std::size_t>(cursor)] == key;
    for (std::size_t k = 0; k < last.history.size(); ++k) {
      history_[k][lane] = known ? last.history[k][static_cast<std::size_t>(cursor)] : 0.0;
    }
  }
  /// Lanes that no contact fills repeat another, so that they hold ordinary numbers and change nothing.
  void copy_lane(int from, int to) {
    for (auto& row : touch_) row[to] = row[from];
    for (auto& row : encounter_) row[to] = row[from];
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
    return p;
  }
  void set_uniform(std::uint32_t law) {
    for (auto& l : law_) l = law;
    uniform_ = gather_parameters();
    uniform_law_ = law;
  }

  DEM_HOT Pack evaluate(Memories& memories, ContactForces& forces, std::size_t at) {
    bool same = true;
    for (int lane = 0; lane < pack_width; ++lane) same &= law_[lane] == law_[0];
    if (same && law_[0] != uniform_law_) [[unlikely]]
      set_uniform(law_[0]);

    ContactHistory<Model, Pack> history{};
    history.normal = packed<decltype(history.normal)>(history_[0]);
    history.friction = packed<decltype(history.friction)>(&history_[0][0] + normal_history_size<Model> * pack_width);
    const PackParameters parameters = same ? uniform_ : gather_parameters();
    Pack overlap_ratio;
    const Wrench<Pack> w =
        contact_wrench<Model, Pack>(packed<Touch<Pack>>(&touch_[0][0]), packed<Encounter<Pack>>(&encounter_[0][0]),
                                    parameters.normal, parameters.friction, Pack(dt_), history, overlap_ratio);
    store3(w.force, forces.force, at);
    store3(w.torque_i, forces.torque_i, at);
    store3(w.torque_j, forces.torque_j, at);
    store_history(history.normal, memories, 0, at);
    store_history(history.friction, memories, normal_history_size<Model>, at);
    return overlap_ratio;
  }

  template <class History>
  static DEM_HOT void store_history(const History& h, Memories& memories, std::size_t offset, std::size_t at) {
    if constexpr (!std::is_empty_v<History>) {
      const auto packs = std::bit_cast<std::array<Pack, sizeof(History) / sizeof(Pack)>>(h);
      for (std::size_t k = 0; k < packs.size(); ++k) store(packs[k], &memories.now.history[k + offset][at]);
    }
  }
  static DEM_HOT void store3(const Vector3<Pack>& v, std::array<AlignedVector<double>, 3>& columns, std::size_t at) {
    store(v.x, &columns[0][at]);
    store(v.y, &columns[1][at]);
    store(v.z, &columns[2][at]);
  }

  alignas(64) double touch_[touch_size][pack_width];
  alignas(64) double encounter_[encounter_size][pack_width];
  alignas(64) double history_[history_size<Model> > 0 ? history_size<Model> : 1][pack_width];
  std::uint32_t law_[pack_width];
  PackParameters uniform_;
  std::uint32_t uniform_law_ = 0;
  const std::vector<Parameters>& table_;
  double dt_;
};

}  // namespace dem::pipeline
