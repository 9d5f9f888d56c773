#include "bench/present/style.hpp"

#include <fmt/core.h>

#include "bench/present/chart.hpp"
#include "planner/io/text.hpp"

namespace sipplab::bench {
namespace {

constexpr const char* kStyle = R"css(
:root { color-scheme: light dark; --line: #8884; --good: #007a4d; --bad: #b33c00; --soft: #8881; }
@media (prefers-color-scheme: dark) { :root { --good: #4fd69c; --bad: #ff9a66; } }
body { font: 15px/1.45 system-ui, sans-serif; max-width: 1180px; margin: 2em auto; padding: 0 1.2em; }
h1 { font-size: 1.5em; margin-bottom: 0.2em; } h2 { font-size: 1.2em; margin-top: 2em; border-bottom: 1px solid var(--line); }
p.note { opacity: 0.75; margin: 0.4em 0; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: 3px 10px; text-align: left; border-bottom: 1px solid var(--line); white-space: nowrap; }
td.wrap { white-space: normal; } th { font-weight: 600; } td.n, th.n { text-align: right; }
tbody tr:hover { background: var(--soft); }
.scroll { overflow-x: auto; } .good { color: var(--good); } .bad { color: var(--bad); font-weight: 600; }
.charts { display: flex; flex-wrap: wrap; gap: 12px; } .charts svg { max-width: 100%; height: auto; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 2px 1em; margin: 0; } dt { opacity: 0.7; } dd { margin: 0; }
nav a { margin-right: 1em; }
)css";

}  // namespace

std::string page_head(const std::string& title) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n",
      xml_escaped(title), kStyle);
}

}  // namespace sipplab::bench
