/// The report of a characterisation: of a recording, or of the recordings of a device.
#include "schema/figure/drawing.hpp"
#include "schema/json/characterisation_figures.hpp"
#include "schema/json/report/bodies.hpp"
#include "schema/json/report/html.hpp"
#include "schema/json/stored_channel.hpp"

namespace driftlab::page {
namespace {

/// A recording: for each channel its sentence, the evidence and its figure; then what is true of the file.
std::string recording_html(const Json& recording) {
  const auto id = recording.at("id").get<std::string>();
  std::string text = "<h2>" + html(id) + "</h2>\n" + list_html(recording.at("quality").at("notes"));
  for (const Json& channel : recording.at("channels")) {
    const auto told = stored_channel_from_json(channel);
    text += "<section>\n<h2>" + html(channel.at("channel").get<std::string>()) + "</h2>\n";
    if (told) {
      const Verdict verdict = verdict_of(*told);
      text += verdict_html(mark_of(std::string(name_of(verdict.level))) + " " + verdict.sentence) +
              list_html(Json(verdict.details));
    }
    if (told && !told->allan.tau_s.empty()) {
      text += figure::to_svg(allan_figure(*told, id));
    }
    text += list_html(channel.at("warnings")) + "</section>\n";
  }
  return text;
}

}  // namespace

std::string characterisation_html(const Json& document) {
  std::string text;
  for (const Json& recording : document.at("recordings")) {
    text += recording_html(recording);
  }
  return text;
}

}  // namespace driftlab::page
