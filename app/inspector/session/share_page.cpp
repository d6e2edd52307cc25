#include "inspector/session/share_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "broadmark/parameters.h"
#include "inspector/session/frame_provider_requests.h"
#include "request/inspector_options.h"
#include "request/reading_options.h"
#include "support/words.h"

namespace broadmark {
namespace {

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = i; k < i + 3; ++k) {
      bits = bits << 8 | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U);
    }
    for (std::size_t digit = 0; digit < 4; ++digit) {
      const bool is_padding = i + digit > bytes.size();
      text += is_padding ? '=' : kDigits[bits >> (18 - 6 * digit) & 63];
    }
  }
  return text;
}

/// The arguments for a scene with its parameters that differ from the defaults.
std::vector<std::string> sceneArguments(ParameterValues values) {
  const std::string scene = values.extract("scene").mapped();
  const auto fresh = makeSimulation(scene, values["engine"]);
  std::vector<std::string> arguments = {scene, "--engine=" + values["engine"]};
  for (const auto& [key, value] : changedValues(std::move(values), *fresh)) {
    arguments.push_back(fmt::format("--param={}={}", key, value));
  }
  return arguments;
}

std::string percentEncoded(std::string_view text) {
  constexpr std::string_view kUnreserved =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.~=,:/";
  std::string encoded;
  for (const char c : text) {
    const bool is_plain = kUnreserved.find(c) != kUnreserved.npos;
    encoded += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return encoded;
}

}  // namespace

std::vector<std::string> openingArguments(const Session& session, const OrbitCamera& camera) {
  const auto source = session.playback.source();
  if (!source) return {};
  std::vector<std::string> arguments;
  if (!source->recording.empty()) {
    arguments = {source->recording.string()};
  } else if (source->origin == FrameOrigin::simulation) {
    arguments = sceneArguments(sceneParametersOf(source.get()));
  } else {
    return {};
  }
  for (const auto& [key, value] : session.playback.reading) {
    arguments.push_back(parameterOption(key) + (value == "on" ? "" : "=" + value));
  }
  std::vector<std::string> ids;
  std::set<std::string> options;
  for (const TrackEdit& track : session.tracks.list) {
    const Algorithm& algorithm = track.test_case.algorithm;
    ids.push_back(algorithm.id);
    if (!algorithm.plugin.empty()) options.insert("--plugin=" + algorithm.plugin);
    for (const auto& [key, value] : track.test_case.parameters) {
      options.insert(fmt::format("--param={}:{}={}", algorithm.id, key, value));
    }
  }
  if (!ids.empty()) arguments.push_back(fmt::format("--algorithm={}", fmt::join(ids, ",")));
  arguments.insert(arguments.end(), options.begin(), options.end());
  arguments.push_back(fmt::format("--frame={}", session.playback.frame()));
  const BodySelection::Bodies& selected = session.selection.bodies();
  if (!selected.empty()) arguments.push_back(fmt::format("--select={}", fmt::join(selected, ",")));
  arguments.push_back("--camera=" + cameraText(camera));
  return arguments;
}

std::string openingCommand(const Session& session, const OrbitCamera& camera) {
  std::string command;
  for (const std::string& argument : openingArguments(session, camera)) {
    command += (command.empty() ? "broadmark " : " ") + shellQuoted(argument);
  }
  return command;
}

std::string openingLink(const Session& session, const OrbitCamera& camera, std::string_view page) {
  std::string link(page);
  for (const std::string& argument : openingArguments(session, camera)) {
    link += (link.size() == page.size() ? '#' : '&') + percentEncoded(argument);
  }
  return link;
}

std::string sharePage(const Session& session, const OrbitCamera& camera, const AnswerText& answer,
                      std::string_view png) {
  const std::string command = openingCommand(session, camera);
  const std::string title =
      fmt::format("{}, frame {}", session.playback.scene().name, session.playback.frame());
  return fmt::format(
      R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<meta name="viewport" content="width=device-width">
<style>
body {{ max-width: 75rem; margin: 2rem auto; padding: 0 1rem; font: 16px/1.5 sans-serif; color-scheme: light dark }}
img {{ max-width: 100%; height: auto }}
pre {{ white-space: pre-wrap; overflow-wrap: anywhere; padding: 1rem; border: 1px solid }}
</style></head><body>
<h1>{title}</h1>
<p>{answer}{comparison}.</p>
<img alt="The inspector" src="data:image/png;base64,{picture}">
{command}
</body></html>
)",
      fmt::arg("title", escapedForXml(title)), fmt::arg("answer", escapedForXml(answer.answer)),
      fmt::arg("comparison",
               escapedForXml(answer.comparison.empty() ? std::string() : "; " + answer.comparison)),
      fmt::arg("picture", base64(png)),
      fmt::arg("command", command.empty()
                              ? std::string()
                              : fmt::format("<p>To open it in Broadmark:</p>\n<pre>{}</pre>",
                                            escapedForXml(command))));
}

}  // namespace broadmark
