// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

/// The style of a page: light, dark, and for paper. Every pair of colours of text has a contrast of 4.5 or more.
inline constexpr auto page_style = R"css(
:root { --ground: #ffffff; --text: #1b1d21; --quiet: #555a63; --line: #d4d7dd; --panel: #f4f5f7; --link: #0b57b0;
  --good: #17692f; --bad: #a81f17; color-scheme: light dark }
@media (prefers-color-scheme: dark) {
  :root { --ground: #15171b; --text: #e7e9ed; --quiet: #a9b0bb; --line: #3b404a; --panel: #20242b; --link: #8ab8ff;
    --good: #74d28d; --bad: #ff9d94 } }
* { box-sizing: border-box }
body { margin: 0 auto; padding: 1.5rem 1rem 4rem; max-width: 62rem; background: var(--ground); color: var(--text);
  font: 1rem/1.55 system-ui, "DejaVu Sans", sans-serif; overflow-wrap: break-word }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 .3rem }
h2 { font-size: 1.2rem; margin: 2.4rem 0 .6rem; padding-top: .6rem; border-top: 1px solid var(--line) }
h3 { font-size: 1rem; margin: 1.4rem 0 .4rem }
p { margin: .5rem 0; max-width: 46rem }
a { color: var(--link) }
nav ul { list-style: none; padding: 0; display: flex; flex-wrap: wrap; gap: .2rem 1.1rem; font-size: .9rem }
.verdict { margin: 1rem 0; padding: .7rem 1rem; background: var(--panel); border-left: .35rem solid var(--bad) }
.verdict.good { border-left-color: var(--good) }
.verdict strong { color: var(--bad) }
.verdict.good strong { color: var(--good) }
.verdict ul { margin: .4rem 0; padding-left: 1.2rem }
.quiet, caption, figcaption small { color: var(--quiet) }
.wide, pre, .formula { overflow-x: auto; overflow-y: hidden; margin: .8rem 0 }
table { border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums }
caption { text-align: left; padding-bottom: .3rem }
th, td { text-align: left; vertical-align: top; padding: .25rem .9rem .25rem 0; border-bottom: 1px solid var(--line);
  font-weight: normal; white-space: pre-line }
thead th { font-weight: 600 }
thead + tbody td:not(.number) { min-width: 8rem }
td.number { text-align: right; white-space: nowrap }
pre { background: var(--panel); padding: .7rem 1rem; font: .85rem/1.45 "DejaVu Sans Mono", ui-monospace, monospace }
code { font-family: "DejaVu Sans Mono", ui-monospace, monospace }
figure { margin: 1.4rem 0 }
img { display: block; width: 100%; max-width: 54rem; height: auto; background: #ffffff; border: 1px solid var(--line) }
figcaption { margin-top: .5rem; max-width: 46rem }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 22rem), 1fr)); gap: 0 1.2rem }
summary { cursor: pointer; color: var(--link) }
math { font-size: 1.05rem }
mtd { text-align: left; padding: .2rem 0 }
math[display="block"] { width: fit-content; margin: 0 }
:focus-visible { outline: 2px solid var(--link); outline-offset: 2px }
@media print {
  :root { --ground: #ffffff; --text: #000000; --quiet: #444444; --line: #bbbbbb; --panel: #ffffff; --link: #000000;
    --good: #000000; --bad: #000000 }
  body { max-width: none; padding: 0; font-size: 10pt }
  nav, details { display: none }
  pre, .wide, .formula { overflow: visible; white-space: pre-wrap }
  figure, tr { break-inside: avoid } }
)css";

}  // namespace delf
