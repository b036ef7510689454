#pragma once

#include <dem/mbd/solver/solver.hpp>

#include <string>
#include <utility>

namespace dem::mbd {

/// Calls a function that lives elsewhere: what adds the forces from outside.
class PutForces {
 public:
  template <class F>
  explicit PutForces(F& f) : f_(&f), call_([](void* it) { (*static_cast<F*>(it))(); }) {}
  void operator()() const { call_(f_); }

 private:
  void* f_;
  void (*call_)(void*);
};

/// The Solver of a mechanism that stays a bare ground in many programs: those whose walls never move. Only programs
/// that call take_on(), before they add anything to the mechanism, compile what moves bodies and closes joints. To all
/// others the ground is still and limits nothing. Functions are those of Solver.
template <integrator::Integrator I, JointPolicy Joints = Penalty>
class LazySolver {
 public:
  using Whole = Solver<I, Joints>;

  LazySolver() = default;
  LazySolver(const LazySolver&) = default;
  LazySolver(LazySolver&&) = default;
  // Whoever asked for the mechanism may still hold it, and add to it.
  LazySolver& operator=(const LazySolver& s) {
    solver_ = s.solver_;
    if (s.calls_) calls_ = s.calls_;
    return *this;
  }
  LazySolver& operator=(LazySolver&& s) {
    solver_ = std::move(s.solver_);
    if (s.calls_) calls_ = s.calls_;
    return *this;
  }

  /// From here on there may be more than a ground.
  void take_on() { calls_ = &calls; }
  Whole& whole() { return take_on(), solver_; }

  void design(Mechanism& m, double dt, const Vec3& gravity, bool has_run) {
    calls_ ? calls_->design(solver_, m, dt, gravity, has_run) : solver_.design_bare(dt);
  }
  MachineDesign tried(const Mechanism& m, double dt, const Vec3& gravity, bool has_run) const {
    return calls_ ? calls_->tried(solver_, m, dt, gravity, has_run) : MachineDesign{};
  }
  void close_joints(Mechanism& m) {
    if (calls_) calls_->close_joints(solver_, m);
  }
  MachineReport report(const Mechanism& m) const { return calls_ ? calls_->report(solver_, m) : MachineReport{}; }
  MachineReport newly_opened(const Mechanism& m) { return calls_ ? calls_->newly_opened(solver_, m) : MachineReport{}; }
  std::string note(const Mechanism& m) const { return calls_ ? calls_->note(solver_, m) : std::string(); }

  StableTimeStep stable_time_step(const Mechanism& m) const {
    return calls_ ? calls_->stable_time_step(solver_, m) : StableTimeStep{};
  }
  StableTimeStep stable_time_step_of_given(const Mechanism& m) const {
    return calls_ ? calls_->stable_time_step_of_given(solver_, m) : StableTimeStep{};
  }

  double design_step() const { return solver_.design_step(); }
  void note_stable_step(const Mechanism& m) {
    if (calls_) calls_->note_stable_step(solver_, m);
  }
  bool is_initialised(const Mechanism& m) const { return solver_.is_initialised(m); }
  bool is_designed_for(const Mechanism& m, double dt) const { return solver_.is_designed_for(m, dt); }
  void check_motions(Mechanism& m) const {
    if (calls_) calls_->check_motions(solver_, m);
  }

  template <class F>
  void initialise(Mechanism& m, double time, double dt, const Vec3& gravity, F&& put_forces) {
    if (calls_) calls_->initialise(solver_, m, time, dt, gravity, PutForces(put_forces));
    else solver_.initialise_bare(m, time, put_forces);
  }
  template <class F>
  void stage(Mechanism& m, int stage, double dt, const Vec3& gravity, F&& put_forces) {
    if (calls_) calls_->stage(solver_, m, stage, dt, gravity, PutForces(put_forces));
    else solver_.stage_bare(m, stage, dt, put_forces);
  }

  template <class V>
  void fields(V& v) {
    solver_.fields(v);
  }

 private:
  struct Calls {
    void (*design)(Whole&, Mechanism&, double, const Vec3&, bool);
    MachineDesign (*tried)(const Whole&, const Mechanism&, double, const Vec3&, bool);
    void (*close_joints)(Whole&, Mechanism&);
    MachineReport (*report)(const Whole&, const Mechanism&);
    MachineReport (*newly_opened)(Whole&, const Mechanism&);
    std::string (*note)(const Whole&, const Mechanism&);
    StableTimeStep (*stable_time_step)(const Whole&, const Mechanism&);
    StableTimeStep (*stable_time_step_of_given)(const Whole&, const Mechanism&);
    void (*note_stable_step)(Whole&, const Mechanism&);
    void (*check_motions)(const Whole&, Mechanism&);
    void (*initialise)(Whole&, Mechanism&, double, double, const Vec3&, PutForces);
    void (*stage)(Whole&, Mechanism&, int, double, const Vec3&, PutForces);
  };
  static constexpr Calls calls = {
      .design = [](Whole& s, Mechanism& m, double dt, const Vec3& gravity,
                   bool has_run) { s.design(m, dt, gravity, has_run); },
      .tried = [](const Whole& s, const Mechanism& m, double dt, const Vec3& gravity,
                  bool has_run) { return s.tried(m, dt, gravity, has_run); },
      .close_joints = [](Whole& s, Mechanism& m) { s.close_joints(m); },
      .report = [](const Whole& s, const Mechanism& m) { return s.report(m); },
      .newly_opened = [](Whole& s, const Mechanism& m) { return s.newly_opened(m); },
      .note = [](const Whole& s, const Mechanism& m) { return s.note(m); },
      .stable_time_step = [](const Whole& s, const Mechanism& m) { return s.stable_time_step(m); },
      .stable_time_step_of_given = [](const Whole& s, const Mechanism& m) { return s.stable_time_step_of_given(m); },
      .note_stable_step = [](Whole& s, const Mechanism& m) { s.note_stable_step(m); },
      .check_motions = [](const Whole& s, Mechanism& m) { s.check_motions(m); },
      .initialise = [](Whole& s, Mechanism& m, double time, double dt, const Vec3& gravity,
                       PutForces put_forces) { s.initialise(m, time, dt, gravity, put_forces); },
      .stage = [](Whole& s, Mechanism& m, int stage, double dt, const Vec3& gravity,
                  PutForces put_forces) { s.stage(m, stage, dt, gravity, put_forces); },
  };

  Whole solver_;
  const Calls* calls_ = nullptr;  // none: the mechanism is a bare ground
};

}  // namespace dem::mbd
