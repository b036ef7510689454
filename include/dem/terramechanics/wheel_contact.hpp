#pragma once

#include <dem/terramechanics/numerics.hpp>
#include <dem/terramechanics/slip.hpp>
#include <dem/terramechanics/soil.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace dem::terramechanics {

/// A rigid wheel. With grousers the soil between them turns with the wheel, so shear acts at a radius
/// r + grouser_share times their height (Ding et al., J. Terramechanics 48, 2011, 27-45), with eq. 11 for the slip of
/// that radius; pressure acts at r.
struct Wheel {
  double radius = 0.0;          ///< r, m, without grousers
  double width = 0.0;           ///< b, m
  double grouser_height = 0.0;  ///< m
  double grouser_share = 1.0;   ///< 0 to 1: 1 where they stand so close that the soil shears off over their tips

  double shear_radius() const { return radius + grouser_share * grouser_height; }
};

/// Throws Error unless radius and width are positive and the grousers lower than the radius.
inline void check_wheel(const Wheel& wheel) {
  require_positive(wheel.radius, "wheel radius", "m");
  require_positive(wheel.width, "wheel width", "m");
  if (!(wheel.grouser_height >= 0.0 && wheel.grouser_height < wheel.radius)) {
    fail("the wheel's grousers are {:g} m high, but must be at least 0 (none) and below the wheel's radius, {:g} m",
         wheel.grouser_height, wheel.radius);
  }
  require_within(wheel.grouser_share, 0.0, 1.0, "share of the grousers' height that counts");
}

/// Which way the soil is sheared under a wheel that brakes (s < 0).
enum class BrakedShear {
  two_zones,  ///< thesis eqs. 9 and 11: backwards in front of theta_m, forwards behind it, each from 0 at theta_m
  one_path    ///< the way that the rim slides since it entered the soil, with its sign: eq. 11 for s >= 0 at any slip
};

/// How a wheel's stresses are computed where the thesis leaves a choice.
struct WheelModel {
  BrakedShear braked = BrakedShear::two_zones;
  /// Eqs. 9 and 11 jump at s = 0, where the shear stress in front changes its sign. From s = -bridge to 0 the shear
  /// stress goes linearly from that of s < 0 to that of s >= 0. 0 leaves the jump; one_path has none and needs no
  /// bridge.
  double bridge = 0.05;
};

/// Stresses between a rigid wheel and the soil at one sinkage and slip (thesis eqs. 5-11). Angles theta (rad) count
/// from the lowest point, positive in front of it. Slip may be given by any SlipDefinition and with any sign; eqs. 7
/// and 11 take it by the wheel's speed, s = 1 - v/(omega r), with which alone eq. 11 is the path that the rim slides.
/// Eq. 11 for s < 0 is misprinted: its part in front of theta_m is taken as what is 0 at theta_m and theta_f, r (1 - s)
/// [(theta_f - theta) (sin theta_f - sin theta_m)/(theta_f - theta_m) - sin theta_f + sin theta].
class WheelContact {
 public:
  /// Nothing is checked; wheel_forces checks.
  WheelContact(const Wheel& wheel, const Soil& soil, const Slip& slip, double sinkage, const WheelModel& model = {})
      : curve_(under(soil.pressure, wheel.width)),
        shear_(soil.shear),
        radius_(wheel.radius),
        shear_radius_(wheel.shear_radius()),
        ratio_(slip.speed_ratio()),
        shear_ratio_(ratio_ * radius_ / shear_radius_),
        entry_(angle_at(sinkage, radius_)) {
    exit_ = soil.exit_share > 0.0 ? -angle_at(soil.exit_share * sinkage, radius_) : std::max(soil.exit_angle, -entry_);
    peak_ = std::clamp(soil.a0 + soil.a1 * (1.0 - ratio_), 0.0, 1.0) * entry_;
    shear_entry_ = angle_at(sinkage + (shear_radius_ - radius_), shear_radius_);
    const double s = 1.0 - shear_ratio_;
    driven_ = model.braked == BrakedShear::one_path ? 1.0
              : model.bridge > 0.0                  ? std::clamp(1.0 + s / model.bridge, 0.0, 1.0)
              : s >= 0.0                            ? 1.0
                                                    : 0.0;
    // Grousers slide before the rim enters: the way may turn before that, where nothing presses.
    turns_ = {driven_ > 0.0 ? std::min(turn_from(shear_entry_), entry_) : exit_,
              driven_ < 1.0 ? turn_from(peak_) : exit_};
  }

  double entry() const { return entry_; }                ///< theta_f
  double exit() const { return exit_; }                  ///< theta_r
  double peak() const { return peak_; }                  ///< theta_m, where the pressure is largest
  double speed_ratio() const { return ratio_; }          ///< v/(omega r)
  double shear_radius() const { return shear_radius_; }  ///< m
  /// Where the stresses bend, ascending, from the exit to the entry; some may be equal.
  std::array<double, 5> bends() const {
    std::array<double, 5> at = {exit_, turns_[0], turns_[1], peak_, entry_};
    std::sort(at.begin(), at.end());
    return at;
  }

  /// m, that counts for the pressure (eqs. 6, 8).
  double sinkage(double theta) const {
    const double at = theta >= peak_ ? theta : entry_ - (entry_ - peak_) * (theta - exit_) / (peak_ - exit_);
    // cos(at) - cos(entry) without the cancellation near the entry.
    return 2.0 * radius_ * std::sin(0.5 * (entry_ + at)) * std::sin(0.5 * (entry_ - at));
  }
  /// sigma, Pa (eq. 5, or whatever pressure law the soil has).
  double pressure(double theta) const { return curve_.pressure(sinkage(theta)); }

  /// j, m: the way that the rim slid backwards since it entered the soil (eq. 11 for s >= 0).
  double driven_displacement(double theta) const { return slid(shear_entry_, theta); }
  /// j, m, of a wheel that brakes (eq. 11 for s < 0).
  double braked_displacement(double theta) const {
    if (theta < peak_) return slid(peak_, theta);
    const double chord = (std::sin(shear_entry_) - std::sin(peak_)) / (shear_entry_ - peak_);
    return shear_radius_ * shear_ratio_ * ((shear_entry_ - theta) * chord - std::sin(shear_entry_) + std::sin(theta));
  }
  /// tau, Pa, at a pressure (Pa) there; positive drives the wheel forwards (eq. 9).
  double shear(double theta, double pressure) const {
    double share = 0.0;
    if (driven_ > 0.0) {
      const double j = driven_displacement(theta);
      share += driven_ * std::copysign(shear_.mobilised(j), j);
    }
    if (driven_ < 1.0) {
      const double braked = shear_.mobilised(braked_displacement(theta));
      share += (1.0 - driven_) * (theta >= peak_ ? -braked : braked);
    }
    return share * shear_.strength(pressure);
  }

 private:
  /// Of a height (m) over the lowest point of a circle; by the half angle, as cosines of small angles have no digits.
  static double angle_at(double height, double radius) {
    return 2.0 * std::asin(std::sqrt(std::clamp(0.5 * height / radius, 0.0, 1.0)));
  }
  /// The way (m) that the rim slid since it was at the angle `from`.
  double slid(double from, double theta) const {
    return shear_radius_ * ((from - theta) - shear_ratio_ * (std::sin(from) - std::sin(theta)));
  }
  /// Where the way that the rim slid since `from` is 0 again, as it goes back and then forth; the exit if nowhere.
  double turn_from(double from) const {
    if (!(shear_ratio_ > 1.0)) return exit_;
    const double furthest = std::acos(1.0 / shear_ratio_);
    if (!(furthest < from && furthest > exit_ && slid(from, exit_) < 0.0)) return exit_;
    return find_root([&](double theta) { return slid(from, theta); }, exit_, furthest);
  }

  PressureCurve curve_;
  JanosiHanamoto shear_;
  double radius_, shear_radius_, ratio_, shear_ratio_;
  double entry_, exit_ = 0.0, peak_ = 0.0, shear_entry_ = 0.0;
  double driven_ = 1.0;  ///< share of the stresses of a wheel that drives
  std::array<double, 2> turns_{};
};

}  // namespace dem::terramechanics
