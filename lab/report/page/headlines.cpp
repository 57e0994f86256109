// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/headlines.hpp"

#include "base/text.hpp"
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"
#include "lab/report/page/prose.hpp"
#include "payoff/kernel_bench.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace meshorder {
namespace {

std::string bar(std::string_view kind, double ms, double most, const std::string& title) {
  return fmt::format("<div class=\"{}\"><span style=\"width:{:.1f}%\"></span><b>{} ms</b> {}</div>", kind,
                     100 * ms / most, with_digits(ms, 3), xml_escaped(title));
}

/// Returns the bars of the kernels that were timed in both orders.
std::string bars(const StudyResults& results, const MeshOrderRecord& as_it_is,
                 const MeshOrderRecord& ordered) {
  const bool is_matrix = as_it_is.kernels[1].measured_ms <= 0;
  std::string html;
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    const double before = as_it_is.kernels[k].measured_ms;
    const double after = ordered.kernels[k].measured_ms;
    if (before <= 0 || after <= 0) continue;
    const double most = std::max(before, after);
    html += fmt::format("<dt>{}</dt><dd>{}{}</dd>\n", is_matrix ? "product" : kKernelTitles[k],
                        bar("before", before, most, title_of(results, as_it_is.ordering)),
                        bar("after", after, most, title_of(results, ordered.ordering)));
  }
  return html;
}

}  // namespace

std::string headlines_of(const StudyResults& results) {
  if (!results.scenarios.empty()) return "";
  std::string html;
  for (const MeshRecord& mesh : results.meshes) {
    const MeshOrderRecord* const as_it_is = find_order(mesh, "original");
    const MeshOrderRecord* const ordered = find_order(mesh, "meshorder");
    const std::string of_kernels =
        as_it_is != nullptr && ordered != nullptr ? bars(results, *as_it_is, *ordered) : "";
    if (of_kernels.empty() && mesh.verdict.empty()) continue;
    html += "<div class=\"headline\"><div>";
    if (results.meshes.size() > 1) html += fmt::format("<h3>{}</h3>", xml_escaped(mesh.name));
    if (mesh.gain > 1)
      html += fmt::format("<p class=\"gain\">{}× <span>faster at best</span></p>", with_digits(mesh.gain, 2));
    if (!mesh.verdict.empty())
      html += fmt::format("<p class=\"answer\">{}.</p>", prose_as_html(mesh.verdict));
    html += "</div>\n";
    if (!of_kernels.empty()) {
      html += fmt::format(
          "<div><dl>{}</dl>\n<p class=\"hint\">Best time of one run of each kernel, measured here.</p></div>",
          of_kernels);
    }
    html += "</div>\n";
  }
  return html;
}

}  // namespace meshorder
