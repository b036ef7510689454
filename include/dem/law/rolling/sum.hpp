#pragma once

#include <dem/law/rolling/rolling_law.hpp>

#include <type_traits>

namespace dem::rolling {

/// Two laws at once: rolling::Sum<rolling::ElasticPlastic, rolling::Torsion>.
template <class First, class Second>
struct Sum {
  static_assert(!std::is_same_v<First, Second>, "rolling::Sum: the two laws must differ");
  static_assert(contact::field_count<typename First::template Parameters<double>> > 0 &&
                    contact::field_count<typename Second::template Parameters<double>> > 0,
                "rolling::Sum: both laws must have parameters; for one of them alone name it without Sum");

  template <class T>
  struct Parameters {
    typename First::template Parameters<T> first;
    typename Second::template Parameters<T> second;
  };
  // Bases, so that the history of a law that remembers nothing takes no memory.
  template <class T>
  struct History : First::template History<T>, Second::template History<T> {};

  template <class T>
  static DEM_HOT Vector3<T> torque(const Parameters<T>& p, const RollingState<T>& s, History<T>& h) {
    return First::torque(p.first, s, static_cast<typename First::template History<T>&>(h)) +
           Second::torque(p.second, s, static_cast<typename Second::template History<T>&>(h));
  }
  template <class T, class Turn>
  static DEM_HOT void carry(History<T>& h, Turn&& turn) {
    First::carry(static_cast<typename First::template History<T>&>(h), turn);
    Second::carry(static_cast<typename Second::template History<T>&>(h), turn);
  }

  // Rolling and twisting are different motions; for two laws of one motion the sum is what they do together.
  static double stiffness(const Parameters<double>& p, const contact::NormalState<double>& s) {
    return First::stiffness(p.first, s) + Second::stiffness(p.second, s);
  }
  static double damping(const Parameters<double>& p, const contact::NormalState<double>& s) {
    return contact::damping_of<First>(p.first, s) + contact::damping_of<Second>(p.second, s);
  }
  static double energy(const Parameters<double>& p, double radius, const History<double>& h) requires requires {
    First::energy(p.first, radius, h);
    Second::energy(p.second, radius, h);
  }
  { return First::energy(p.first, radius, h) + Second::energy(p.second, radius, h); }
  static void check(const Parameters<double>& p) {
    First::check(p.first);
    Second::check(p.second);
  }
};

}  // namespace dem::rolling
