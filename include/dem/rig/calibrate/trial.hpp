#pragma once
// One run of the rigs at one place: what they measure with these constants.

#include <dem/rig/calibrate/settings.hpp>
#include <dem/rig/direct_shear/evaluate.hpp>
#include <dem/rig/direct_shear/resolve.hpp>
#include <dem/rig/file_names.hpp>
#include <dem/rig/plate_sinkage/tables.hpp>
#include <dem/rig/run_within.hpp>
#include <dem/rig/sand_pile/resolve.hpp>
#include <dem/rig/sand_pile/results.hpp>
#include <dem/rig/session.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace dem::rig::calibrate {

/// The worlds that the rigs are run with, compiled beside it: what the examples of these rigs have.
struct Worlds {
  void (*shear)(const direct_shear::Settings&, direct_shear::Campaign&, Session&);
  void (*press)(const plate_sinkage::Settings&, plate_sinkage::Campaign&, Session&);
  void (*cubes)(const sand_pile::Settings&, sand_pile::PileResult&, report::Replay*, Session&, Stages&);
  void (*spheres)(const sand_pile::Settings&, sand_pile::PileResult&, report::Replay*, Session&, Stages&);
};

/// What is told by one of several rigs that run one after the other.
class ShareOf final : public Stages {
 public:
  ShareOf(Stages& all, std::size_t part, std::size_t of) : all_(all), part_(part), of_(of) {}
  void update(double done, std::string_view status = {}) override {
    all_.update((static_cast<double>(part_) + done) / static_cast<double>(of_), status);
  }
  void go_on() override { all_.go_on(); }
  void message(std::string_view text) override { all_.message(text); }

 private:
  Stages& all_;
  std::size_t part_, of_;
};

/// A set of values of the constants, with the seed of the grains.
struct Trial {
  std::size_t point = 0;  ///< 0: of the target that is made
  std::uint64_t seed = 1;
  std::vector<double> values = {};   ///< of the constants, in their order
  std::vector<double> results = {};  ///< of the quantities; NaN of a run that did not come to its end
};

namespace detail {

/// Sets what rigs call alike.
template <class RigSettings>
void set_constants(RigSettings& grains, const std::vector<Constant>& constants, const std::vector<double>& values) {
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (constants[k] == Constant::friction) grains.friction = values[k];
    if (constants[k] == Constant::stiffness) grains.stiffness = values[k];
  }
}
inline void set_density(double& density, const std::vector<Constant>& constants, const std::vector<double>& values) {
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (constants[k] == Constant::density) density = values[k];
  }
}

/// The settings of a rig for a trial. Throws Error for what the rig refuses.
inline direct_shear::Settings shear_settings(const Settings& s, const Trial& t, const std::string& output) {
  direct_shear::Settings d;
  d.size = s.size;
  d.loads = s.loads;
  hold(d, s.held);
  if (s.held.relative_density >= 0.0) d.relative_density = s.held.relative_density;
  set_constants(d, constants_of(s), t.values);
  set_density(d.relative_density, constants_of(s), t.values);
  d.seed = t.seed;
  d.threads = 1;
  d.replay = d.vtk = false;
  d.output = output;
  direct_shear::resolve(d);
  return d;
}

inline double measure_phi(const Settings& s, const Trial& t, const Worlds& worlds, Session& session) {
  const auto d = shear_settings(s, t, session.folder().string());
  direct_shear::Campaign campaign;
  worlds.shear(d, campaign, session);
  const auto line = direct_shear::fit(campaign).origin;
  return line ? terramechanics::degrees(line->friction_angle) : std::nan("");
}

inline plate_sinkage::Settings plate_settings(const Settings& s, const Trial& t, const std::string& output) {
  plate_sinkage::Settings p;
  p.size = s.size;
  p.widths = s.plates.empty() ? std::vector{size_named(s.size) == Size::smoke ? 0.03 : 0.05} : s.plates;
  p.length = s.plate_length;
  p.plate_friction = s.plate_friction;
  p.sinkage = s.sinkage;
  p.bed.fall_speed = s.fall_speed;
  p.bed.length = s.bed_length, p.bed.width = s.bed_width, p.bed.depth = s.bed_depth;
  hold(p.grains, s.held);
  if (s.held.relative_density >= 0.0) p.bed.relative_density = s.held.relative_density;
  set_constants(p.grains, constants_of(s), t.values);
  set_density(p.bed.relative_density, constants_of(s), t.values);
  p.bed.seed = t.seed;
  p.bed.threads = 1;
  p.replay = p.vtk = false;
  p.output = output;
  plate_sinkage::resolve(p);
  return p;
}

/// What a plate has told.
struct Pressed {
  double pressure = std::nan(""), exponent = std::nan("");
};
inline Pressed press(const Settings& s, const Trial& t, const Worlds& worlds, Session& session) {
  const auto p = plate_settings(s, t, session.folder().string());
  plate_sinkage::Campaign campaign;
  worlds.press(p, campaign, session);
  const auto& plate = campaign.variants.front().plates.front();
  return {plate_sinkage::mean_pressure(plate, p), plate.fit ? plate.fit->curve.exponent : std::nan("")};
}

inline sand_pile::Settings pile_settings(const Settings& s, const Trial& t, const std::string& output) {
  sand_pile::Settings p;
  p.size = s.size;
  p.kinds = s.kind;
  const auto constants = constants_of(s);
  hold(p, s.held);
  set_constants(p, constants, t.values);
  p.seed = t.seed;
  p.threads = 1;
  p.replay = p.vtk = false;
  p.output = output;
  p.creep_time = 0.01;
  sand_pile::resolve(p);
  double rolling = s.held.rolling;
  for (std::size_t k = 0; k < constants.size(); ++k) {
    if (constants[k] == Constant::rolling) rolling = t.values[k];
  }
  if (rolling >= 0.0) p.rolling_length = p.plate_rolling_length = rolling * p.half_edge;
  return p;
}

inline double measure_repose(const Settings& s, const Trial& t, const Worlds& worlds, Session& session) {
  const auto p = pile_settings(s, t, session.folder().string());
  sand_pile::PileResult result;
  result.kind = sand_pile::kind_named(s.kind);
  result.seed = t.seed;
  session.begin_run(4);
  (s.kind == "cube8" ? worlds.cubes : worlds.spheres)(p, result, nullptr, session, session);
  if (!result.at_rest) {
    session.message(
        text("note: the pile of {} still moved when it was measured", session.folder().filename().string()));
  }
  return terramechanics::degrees(result.flank.angle);
}

/// The constants and the seed of a trial, for the file settings.toml of its runs.
inline std::string values_text(const Settings& s, const Trial& t) {
  std::string lines = text("size=\"{}\"\nseed={}\n", s.size, t.seed);
  const auto constants = constants_of(s);
  for (std::size_t k = 0; k < constants.size(); ++k) {
    lines += text("{}={}\n", names_of_constants[static_cast<int>(constants[k])], t.values[k]);
  }
  return lines;
}

/// Why a rig that ended well has told nothing of a quantity.
inline const char* why_nothing(Quantity q) {
  return q == Quantity::phi      ? "its shear strengths have no line"
         : q == Quantity::repose ? "its pile has no angle, as one of less than three grains' height"
                                 : "its plate's curve has no fit";
}

/// The folder of one run of a trial.
inline std::filesystem::path folder_of(const std::filesystem::path& folder, const Trial& t, Quantity q) {
  return folder / text("{}_{}_{}", t.point, t.seed, names_of_quantities[static_cast<int>(q)]);
}

}  // namespace detail

/// Throws Error, in the words of these options, where a rig refuses what it is given at an end of the ranges.
inline void check_rigs(const Settings& s) {
  for (const std::size_t end : {0U, 1U}) {
    Trial t;
    for (const Constant c : constants_of(s)) t.values.push_back(range_of(s, c)[end]);
    try {
      for (const Quantity q : quantities_of(s)) {
        if (q == Quantity::phi) {
          detail::shear_settings(s, t, s.output);
        } else if (q == Quantity::repose) {
          detail::pile_settings(s, t, s.output);
        } else {
          const auto p = detail::plate_settings(s, t, s.output);
          grains_in(p.bed, p.grains, soil::cube_volume(p.grains.half_edge));
        }
      }
    } catch (const Error& problem) {
      throw Error(in_own_words(problem.what(), own_words(s)));
    }
  }
}

/// Runs the rigs of a trial one after the other, each on one thread and in a folder of its own, and fills in its
/// results. They are kept as `checkpoints` says; the files that they go on from stay until forget_trial(). A run that
/// the simulation stops, or that tells nothing, leaves NaN, and a message says why. Throws Error where such a file is
/// damaged; memory that is out (std::bad_alloc) ends the search.
inline void run_trial(const Settings& s, Trial& t, const Worlds& worlds, const std::filesystem::path& folder,
                      const CheckpointOptions& checkpoints, Stages& stages) {
  const auto quantities = quantities_of(s);
  t.results.assign(quantities.size(), std::nan(""));
  std::optional<detail::Pressed> pressed;  // one plate tells its pressure and its exponent
  bool plate_stopped = false;
  const auto warn_of_nothing = [&](std::size_t q, const std::string& why) {
    const std::string run = detail::folder_of(folder, t, quantities[q]).filename().string();
    stages.message(text("warning: run {} found nothing: {}", run, why));
  };
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    const auto of_plate = [&] { return quantities[q] == Quantity::pressure ? pressed->pressure : pressed->exponent; };
    if (pressed && is_of_plate(quantities[q])) {
      t.results[q] = of_plate();
      if (std::isnan(t.results[q]) && !plate_stopped) warn_of_nothing(q, detail::why_nothing(quantities[q]));
      continue;
    }
    ShareOf share(stages, q, quantities.size());
    const auto own = detail::folder_of(folder, t, quantities[q]);
    const std::string config = detail::values_text(s, t);
    const CheckpointOptions kept = checkpoints_within(checkpoints, "calibrate", own, config);
    Session session({"calibrate", own.string(), config, {}, own_words(s), kept, &share});
    const auto give_up = [&](const std::exception& problem) {
      if (kept.resume && !session.has_begun()) throw;  // what it was to go on from is damaged
      if (is_of_plate(quantities[q])) pressed.emplace(), plate_stopped = true;
      warn_of_nothing(q, session.in_own_words(problem.what()));
    };
    try {
      if (is_of_plate(quantities[q])) pressed = detail::press(s, t, worlds, session);
      t.results[q] = quantities[q] == Quantity::phi      ? detail::measure_phi(s, t, worlds, session)
                     : quantities[q] == Quantity::repose ? detail::measure_repose(s, t, worlds, session)
                                                         : of_plate();
      session.end();
      if (std::isnan(t.results[q])) warn_of_nothing(q, detail::why_nothing(quantities[q]));
    } catch (const Stopped& problem) {
      give_up(problem);
    } catch (const Error& problem) {
      give_up(problem);
    }
  }
}

/// Removes what the runs of a trial were to go on from: its results are in the table.
inline void forget_trial(const Settings& s, const Trial& t, const std::filesystem::path& folder) {
  for (const Quantity q : quantities_of(s)) forget_run_within(detail::folder_of(folder, t, q));
}
/// The same of all runs in the folder.
inline void forget_trials(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) return;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) forget_run_within(entry.path());
}

/// Removes the folders of runs that an earlier search has made there, as a new one begins. What is called otherwise
/// stays.
inline void remove_trials(const std::filesystem::path& folder, Stages& stages) {
  if (!process_writes_files || !std::filesystem::is_directory(folder)) return;
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.symlink_status().type() != std::filesystem::file_type::directory) continue;
    for (const char* quantity : names_of_quantities) {
      if (matches(entry.path().filename().string(), text("#+_#+_{}", quantity))) old.push_back(entry.path());
    }
  }
  if (!old.empty()) {
    stages.message(
        text("Removing {} folders of runs that an earlier search left in '{}'.", old.size(), folder.string()));
  }
  for (const auto& path : old) {
    std::error_code error;
    std::filesystem::remove_all(path, error);
    if (error)
      fail("cannot remove '{}', which an earlier search left ({}); choose another --output", path.string(),
           error.message());
  }
}

}  // namespace dem::rig::calibrate
