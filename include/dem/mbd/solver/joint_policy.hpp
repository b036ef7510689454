#pragma once

namespace dem::mbd {

/// How a machine's joints are held. The other policy is Projected, of <dem/mbd/solver/projected.hpp>.
template <class J>
concept JointPolicy = requires {
  typename J::State;
  requires J::projects || !J::projects;
};

/// By springs and dampers, as the thesis has them. What is not given is derived from the time step.
struct Penalty {
  static constexpr bool projects = false;
  struct State {
    template <class M>
    static void take_springs_off(M&) {}
    template <class M>
    static void start(M&) {}
    template <class M>
    static void begin(M&) {}
    static void forget() {}
    template <class V>
    static void fields(V&) {}
  };
};

template <class J>
constexpr void check_joint_policy() {
  static_assert(JointPolicy<J>, "Joints: must be mbd::Penalty, or mbd::Projected of <dem/mbd/solver/projected.hpp>");
}

}  // namespace dem::mbd
