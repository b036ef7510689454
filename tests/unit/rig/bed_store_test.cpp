// A bed from a file is taken by runs that ask for what it was made with.

#include "catch.hpp"
#include "io/files.hpp"

#include <dem/rig/bed/bed_store.hpp>

#include <map>
#include <string>

namespace bed_store_test {

using Catch::Matchers::ContainsSubstring;
using namespace dem::rig;
using dem::io::Fields;
using dem::io::StateColumns;

namespace {

/// Files without a disk.
std::map<std::string, StateColumns> disk;
constexpr CheckpointFiles files = {
    .write = [](const std::filesystem::path& path, const StateColumns& columns) { disk[path.string()] = columns; },
    .read = [](const std::filesystem::path& path) { return disk.at(path.string()); }};

/// Of a run that ends the part of its bed, which is saved.
void save(Session& session, BedSettings bed, const std::string& file, const char* box = BedStore::fixed_box) {
  bed.save = file;
  BedStore store(session, bed, {}, box);
  StateColumns columns;
  Fields v(Fields::Task::collect, columns);
  bool done = true;
  v("rig/part/done", done);
  CHECK(store.write("bed", columns).empty());
}

const std::string taken = error_of([] {});

/// Of a run that starts from the file.
std::string refusal(Session& session, BedSettings bed, const std::string& file, const GrainSettings& grains = {},
                    const char* box = BedStore::fixed_box) {
  bed.file = file;
  return error_of([&] { BedStore(session, bed, grains, box); });
}

}  // namespace

TEST_CASE("a bed is taken with the settings that it was made with, and what differs is named") {
  TempFolder folder;
  const std::string file = (folder / "bed.h5").string();
  Session session({.program = "rig", .output = (folder / "out").string(), .checkpoints = {.files = files}});
  BedSettings made;
  made.seed = 3;
  made.relative_density = 0.4;
  save(session, made, file);
  CHECK(refusal(session, made, file) == taken);
  BedSettings other = made;
  other.threads = 2, other.sleep = true, other.stage_limit = 9.0;  // change nothing of the bed
  CHECK(refusal(session, other, file) == taken);
  other.seed = 4;
  CHECK_THAT(refusal(session, other, file), ContainsSubstring("was made with --seed 3, but here it is 4"));
  CHECK_THAT(refusal(session, made, file, {.density = 2000.0}),
             ContainsSubstring("--density 2650, but here it is 2000"));
  CHECK_THAT(refusal(session, made, file, {}, BedStore::halves), ContainsSubstring("made with box a fixed box"));
}

TEST_CASE("a bed of a program that lacked an option is one whose option was left alone") {
  TempFolder folder;
  const std::string file = (folder / "bed.h5").string();
  Session session({.program = "rig", .output = (folder / "out").string(), .checkpoints = {.files = files}});
  save(session, {}, file);
  NamesAndValues list;
  Fields from(Fields::Task::restore, disk.at(file));
  from("rig/bed_settings", list);
  REQUIRE(std::erase_if(list, [](const auto& o) { return o.first == "--fall-speed"; }) == 1);
  Fields to(Fields::Task::collect, disk.at(file));
  to("rig/bed_settings", list);

  CHECK(refusal(session, {}, file) == taken);
  BedSettings slow;
  slow.fall_speed = 0.3;
  CHECK_THAT(refusal(session, slow, file), ContainsSubstring("was made with --fall-speed 0, but here it is 0.3"));
}

TEST_CASE("a bed that cannot be saved is told of, and the run goes on with it") {
  struct Told : Stages {
    void message(std::string_view text) override { words += text; }
    std::string words;
  } told;
  TempFolder folder;
  CheckpointFiles full = files;
  full.write = [](const std::filesystem::path&, const StateColumns&) { dem::fail("the disk takes no more"); };
  Session session(
      {.program = "rig", .output = (folder / "out").string(), .checkpoints = {.files = full}, .within = &told});
  session.begin_run(1);
  save(session, {}, (folder / "bed.h5").string());
  CHECK(told.words == "warning: the bed could not be saved, and the run goes on: the disk takes no more");
}

TEST_CASE("a state that no bed was saved to is no bed") {
  TempFolder folder;
  const std::string file = (folder / "run.h5").string();
  Session session({.program = "rig", .output = (folder / "out").string(), .checkpoints = {.files = files}});
  disk[file] = {};
  CHECK_THAT(refusal(session, {}, file), ContainsSubstring("was not written by --save-bed"));
}

}  // namespace bed_store_test
