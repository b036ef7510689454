#pragma once
// The replay as parts of a page.

#include <dem/io/escape.hpp>
#include <dem/report/base64.hpp>
#include <dem/report/replay_encode.hpp>
#include <dem/report/replay_script_camera.hpp>
#include <dem/report/replay_script_data.hpp>
#include <dem/report/replay_script_forces.hpp>
#include <dem/report/replay_script_page.hpp>
#include <dem/report/replay_script_scene.hpp>
#include <dem/report/replay_script_view.hpp>
#include <dem/report/three_js.hpp>

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace dem::report {

namespace detail {

inline constexpr std::string_view kReplayStyle = R"(.replay { --back: #eef1f5; --over: #ffffffd9; --line: #cfd6de; }
@media (prefers-color-scheme: dark) { .replay { --back: #14181d; --over: #1b2027d9; --line: #3a434e; } }
.replay .view, .replay .message { height: min(70vh, 34rem); border: 1px solid var(--line); border-radius: 4px;
  background: var(--back); }
.replay .view { position: relative; overflow: hidden; }
.replay .message { display: flex; align-items: center; justify-content: center; padding: 2rem; height: auto;
  min-height: 8rem; text-align: center; }
.replay canvas { display: block; width: 100%; height: 100%; touch-action: none; cursor: grab; }
.replay canvas:active { cursor: grabbing; }
.replay .legend { position: absolute; left: .7rem; bottom: .7rem; width: 15rem; max-width: 70%; padding: .4rem .7rem;
  border-radius: 4px; background: var(--over); font-size: .8rem; pointer-events: none; }
.replay [hidden] { display: none; }
.replay .bar { height: .6rem; margin: .2rem 0; border-radius: 2px; }
.replay .ends { display: flex; justify-content: space-between; font-variant-numeric: tabular-nums; }
.replay .controls { margin-top: .6rem; font-size: .85rem; }
.replay .controls > div { display: flex; flex-wrap: wrap; align-items: center; gap: .5rem 1.2rem; margin-bottom: .5rem; }
.replay .controls > div:first-child > input { flex: 1; min-width: 10rem; }
.replay .clock { min-width: 5.5rem; text-align: right; font-variant-numeric: tabular-nums; }
.replay label { display: inline-flex; align-items: center; gap: .4rem; }
.replay details label { margin: .2rem 1.2rem .2rem 0; }
.replay button, .replay select { font: inherit; padding: .15rem .6rem; }
.replay button { min-width: 5.5rem; }
.replay input[type=range] { width: 8rem; }
.replay small { opacity: .75; }
)";

}  // namespace detail

/// What a page needs for a replay: the figure itself, and once for all replays of a page a style and scripts.
struct ReplayPage {
  std::string figure, style, scripts;
};

/// The pieces of HTML. Without three.js on this machine the figure only says what to install, and there are no scripts.
/// Throws dem::Error when no frame was recorded.
[[nodiscard]] inline ReplayPage replay_page(const Replay& replay, std::string_view caption = "") {
  const ThreeJs three = find_three_js(replay.options().three_js);
  ReplayPage page{.figure = "<figure class=\"replay\">\n", .style = std::string(detail::kReplayStyle), .scripts = {}};
  if (three.script.empty()) {
    page.figure += fmt::format("<div class=\"message\">{}</div>\n", io::escape_xml(three.missing));
  } else {
    const EncodedReplay encoded = encode(replay);
    page.figure += fmt::format(
        "<div class=\"message\">The replay is loading. It needs JavaScript.</div>\n"
        "<script type=\"application/json\" class=\"head\">{}</script>\n"
        "<script type=\"text/plain\" class=\"data\">{}</script>\n",
        encoded.head, io::base64(encoded.bytes));
    page.scripts = "<script>\n" + three.script + "\n</script>\n<script>\n(() => {\n\"use strict\";\n";
    for (const std::string_view part :
         {detail::kReplayScriptData, detail::kReplayScriptCamera, detail::kReplayScriptScene,
          detail::kReplayScriptForces, detail::kReplayScriptView, detail::kReplayScriptPage}) {
      page.scripts += part;
    }
    page.scripts += "})();\n</script>\n";
  }
  if (!caption.empty()) page.figure += fmt::format("<figcaption>{}</figcaption>", io::escape_xml(caption));
  page.figure += "</figure>\n";
  return page;
}

}  // namespace dem::report
