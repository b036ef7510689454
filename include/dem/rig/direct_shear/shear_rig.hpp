#pragma once

#include <dem/rig/direct_shear/options.hpp>
#include <dem/rig/direct_shear/report.hpp>
#include <dem/rig/direct_shear/resolve.hpp>
#include <dem/rig/direct_shear/result_names.hpp>
#include <dem/rig/direct_shear/shear_world.hpp>
#include <dem/rig/rig.hpp>

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace dem::rig::direct_shear {

/// The direct shear test as a program. It does not know the worlds, so that they are compiled beside it.
class ShearRig : public Rig {
 public:
  /// `elsewhere` says where worlds are that this program does not have.
  ShearRig(std::span<const ShearWorld> worlds, std::string elsewhere)
      : worlds_(worlds), elsewhere_(std::move(elsewhere)) {}

  void declare(Options& options) override { direct_shear::declare(options, settings); }
  void find_idle(IdleOptions& idle) const override { direct_shear::find_idle(idle, settings); }
  void resolve() override { direct_shear::resolve(settings); }
  std::string output() const override { return settings.output; }
  ResultNames results() const override { return result_names(); }
  bool can_resume() const override { return true; }
  std::vector<OwnWord> words() const override {
    return {std::begin(direct_shear::own_words), std::end(direct_shear::own_words)};
  }

  void run(Session& session) override {
    for (const ShearWorld& world : worlds_) {
      if (settings.shape == world.shape && settings.integrator == world.integrator) {
        return world.run(settings, campaign, session);
      }
    }
    throw InAnotherProgram(text("this program has no grains of --shape {} with --integrator {}; {}", settings.shape,
                                settings.integrator, elsewhere_));
  }

  bool report(Report& report) const override { return direct_shear::report(report, settings, campaign); }

  Settings settings;
  Campaign campaign;

 private:
  std::span<const ShearWorld> worlds_;
  std::string elsewhere_;
};

}  // namespace dem::rig::direct_shear
