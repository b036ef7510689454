#pragma once
// The whole replay: recording with or without a world, and what HtmlReport::replay puts into a page.

#include <dem/report/replay_page.hpp>
#include <dem/report/replay_recorder.hpp>
#include <dem/report/replay_world.hpp>
