// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/page.hpp"

#include "base/text.hpp"
#include "io/stream/base64.hpp"
#include "io/stream/output_file.hpp"
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"
#include "lab/report/page/packed_arrays.hpp"
#include "lab/report/tables/tables.hpp"
#include "lab/study/results_json.hpp"
#include "payoff/kernel_bench.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

using Json = nlohmann::ordered_json;

/// Returns a script element with JSON, escaped so that no text in it ends the element.
std::string json_element(std::string_view id, const Json& json) {
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
  return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, text);
}

Json describe(const PageMesh& mesh, const StudyResults& results, PackedArrays& arrays) {
  const MeshRecord* const record = find_named(results.meshes, mesh.name);
  Json json{{"name", mesh.name}};
  if (record != nullptr) json["vertices"] = record->vertices;
  const bool has_surface = !mesh.surface.triangles.empty();  // a matrix has none
  json["positions"] = has_surface ? arrays.add_places(mesh.points) : Json();
  json["triangles"] = has_surface ? arrays.add(mesh.surface.triangles) : Json();
  json["ranks"] = json["sparsity"] = Json::object();
  for (const PageMesh::Order& order : mesh.orders) {
    const auto side = static_cast<std::size_t>(order.sparsity.side);
    if (has_surface) json["ranks"][order.ordering] = arrays.add(order.ranks);
    json["sparsity"][order.ordering] = arrays.add(order.sparsity.counts, {side, side});
  }
  return json;
}

Json describe(const PageMotion& motion, const StudyResults& results, PackedArrays& arrays) {
  const ScenarioRecord* const record = find_named(results.scenarios, motion.scenario);
  Json json{{"scenario", motion.scenario}, {"title", motion.scenario}};
  if (record != nullptr) {
    if (!record->title.empty()) json["title"] = record->title;
    json["mesh"] = record->mesh;
  }
  json["steps"] = motion.steps;
  if (motion.surfaces.empty()) {
    json["triangles"] = arrays.add(motion.surface.triangles);
    json["frames"] = arrays.add_frames(motion.frames);
  }
  for (std::size_t f = 0; f < motion.surfaces.size(); ++f) {
    json["surfaces"].push_back({{"positions", arrays.add_places(motion.frames[f])},
                                {"triangles", arrays.add(motion.surfaces[f].triangles)}});
  }
  json["obstacle"] = nullptr;
  if (!motion.obstacle.triangles.empty()) {
    json["obstacle"] = {{"positions", arrays.add_places(motion.obstacle_points)},
                        {"triangles", arrays.add(motion.obstacle.triangles)}};
  }
  return json;
}

/// Returns the script elements at the end of the page.
std::string data_of(const Page& page) {
  PackedArrays arrays;
  Json manifest{{"orderings", Json::array()}, {"meshes", Json::array()}, {"motions", Json::array()}};
  for (const OrderingSpec& ordering : page.results.orderings)
    manifest["orderings"].push_back({{"name", ordering.name}, {"title", ordering.title}});
  for (const PageMesh& mesh : page.meshes) manifest["meshes"].push_back(describe(mesh, page.results, arrays));
  for (const PageMotion& motion : page.motions)
    manifest["motions"].push_back(describe(motion, page.results, arrays));
  return json_element("results", to_json(page.results)) + json_element("manifest", manifest) +
         arrays.script_elements();
}

std::string words_of(const Page& page) {
  std::vector<std::string_view> words;
  if (!page.results.meshes.empty()) words.emplace_back("meshes");
  const auto is_flat = [](const PageMesh& mesh) { return mesh.surface.triangles.empty(); };
  if (!page.meshes.empty() && std::all_of(page.meshes.begin(), page.meshes.end(), is_flat))
    words.emplace_back("no-surfaces");
  if (!page.results.scenarios.empty()) words.emplace_back("scenarios");
  if (!page.motions.empty()) words.emplace_back("motions");
  return join(words, std::string_view(" "));
}

std::string figures_in(const Page& page, std::string_view section) {
  std::string html;
  for (const Figure& figure : page.figures) {
    if (figure.section != section) continue;
    html += fmt::format(
        "<figure id=\"figure-{}\"><img src=\"data:image/svg+xml;base64,{}\" alt=\"{}\"><figcaption>"
        "<strong>{}</strong> {}</figcaption></figure>\n",
        xml_escaped(figure.name), to_base64(figure.svg), xml_escaped(figure.caption),
        xml_escaped(figure.title), xml_escaped(figure.caption));
  }
  return html;
}

std::string table_of(const Page& page, std::string_view id) {
  const auto table =
      std::find_if(page.tables.begin(), page.tables.end(), [&](const Table& one) { return one.id == id; });
  return table == page.tables.end() ? "" : to_html(*table);
}

std::string findings_in(const Page& page) {
  std::string html;
  for (const std::string& finding : page.findings) html += "<p>" + prose_as_html(finding) + "</p>\n";
  return html;
}

/// Returns `text` with each placeholder `{{words}}` replaced by `value_of(words)`; values are not searched
/// for placeholders. Throws InvalidArgument for a placeholder without end. O(size of the result).
std::string fill_template(std::string_view text,
                          const std::function<std::string(std::string_view)>& value_of) {
  std::string result;
  for (;;) {
    const auto begin = text.find("{{");
    result += text.substr(0, begin);
    if (begin == std::string_view::npos) return result;
    text.remove_prefix(begin + 2);
    const auto end = text.find("}}");
    if (end == std::string_view::npos)
      throw InvalidArgument("a placeholder has no end: {{" + std::string(text.substr(0, 40)));
    result += value_of(text.substr(0, end));
    text.remove_prefix(end + 2);
  }
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

std::string fill_page(std::string_view frame, const Page& page) {
  return fill_template(frame, [&](std::string_view placeholder) -> std::string {
    const auto blank = std::min(placeholder.find(' '), placeholder.size());
    const std::string_view word = placeholder.substr(0, blank);
    const std::string_view name = placeholder.substr(std::min(blank + 1, placeholder.size()));
    if (word == "title") return xml_escaped(page.title);
    if (word == "has") return words_of(page);
    if (word == "headlines") return headlines_of(page.results);
    if (word == "findings") return findings_in(page);
    if (word == "table") return table_of(page, name);
    if (word == "figures") return figures_in(page, name);
    if (word == "style") return std::string(viewer_sources().style);
    if (word == "three") return std::string(viewer_sources().three);
    if (word == "scripts") return std::string(viewer_sources().scripts);
    if (word == "data") return data_of(page);
    throw InvalidArgument("the page's frame has an unknown placeholder: " + std::string(placeholder));
  });
}

std::string to_html(const Page& page) { return fill_page(viewer_sources().page, page); }

void write_page(const Page& page, const FilePath& path) {
  OutputFile file(path);
  file.write(to_html(page));
  file.commit();
}

}  // namespace meshorder
