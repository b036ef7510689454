#pragma once
// The look of the HTML report.

#include <string_view>

namespace dem::io::detail {

inline constexpr std::string_view kHtmlStyle = R"(:root { color-scheme: light dark; }
* { box-sizing: border-box; }
body { margin: 0; background: #fff; color: #222;
  font: 16px/1.55 system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
main { max-width: 60rem; margin: 0 auto; padding: 2rem 1.25rem 4rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 1.2rem; }
h2 { font-size: 1.35rem; margin: 2.4rem 0 .8rem; padding-bottom: .3rem; border-bottom: 1px solid #ddd; }
h3 { font-size: 1.1rem; margin: 1.8rem 0 .6rem; }
p { max-width: 45rem; margin: .8rem 0; }
pre { overflow-x: auto; padding: .8rem 1rem; background: #f5f6f8; border-radius: 4px; font-size: .85rem; }
dl { margin: 1rem 0; columns: 20rem 2; column-gap: 2.5rem; }
dl div { display: flex; justify-content: space-between; gap: 1rem; padding: .25rem 0; border-bottom: 1px solid #eee;
  break-inside: avoid; }
dt { color: #555; }
dd { margin: 0; text-align: right; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
.scroll { overflow-x: auto; margin: 1.2rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { caption-side: top; text-align: left; padding-bottom: .4rem; color: #555; }
th, td { padding: .35rem .9rem; text-align: left; border-bottom: 1px solid #e4e4e4; }
thead th { border-bottom: 2px solid #444; vertical-align: bottom; }
tbody tr:hover { background: #f5f8fb; }
.right { text-align: right; }
td.right { white-space: nowrap; }
.center { text-align: center; }
figure { margin: 1.6rem 0; }
img { max-width: 100%; height: auto; display: block; }
figcaption { margin-top: .4rem; color: #555; font-size: .9rem; }
@media (prefers-color-scheme: dark) {
  body { background: #1b2027; color: #dde2e8; }
  h2, th, td, dl div { border-color: #3a434e; }
  pre, tbody tr:hover { background: #242b33; }
  thead th { border-color: #aab3bd; }
  dt, caption, figcaption { color: #aab3bd; }
  img { background: #fff; }
}
@media print { main { max-width: none; padding: 0; } figure, tr { break-inside: avoid; } }
)";

}  // namespace dem::io::detail
