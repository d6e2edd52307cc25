// The examples of the start page: scenes with algorithms, ready to play.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "broadmark/scenes/simulation.h"
#include "inspector/session/session.h"

namespace broadmark {

struct Example {
  const char* name;
  const char* doc;    ///< one line
  const char* scene;  ///< a built-in one; null: boxes that touch
  std::uint32_t objects;
  std::uint32_t preview_objects;        ///< fewer: of the picture on the start page
  std::vector<const char*> algorithms;  ///< empty: `plugin`'s
  const char* panel;                    ///< to bring to the front
  const char* engine = "";              ///< "": the scene's default
  const char* plugin = nullptr;         ///< see shippedPlugin()
  bool check = true;                    ///< whether to check every answer
  bool beside = false;                  ///< the second algorithm's answer in a second view
};
std::span<const Example> examples();

/// A small version of an example's scene.
std::unique_ptr<Simulation> previewOf(const Example& example);

/// Opens an example and plays it. Reports errors.
void openExample(Session& session, const Example& example);

}  // namespace broadmark
