// The view of the scene: drawn boxes, the camera, and what the mouse does in it.
#pragma once

#include "app/inspector/session.h"
#include "app/inspector/ui.h"
#include "render/gl.h"

namespace broadmark {

class View {
 public:
  explicit View(const Gl& gl);
  ~View();

  /// Fills the current window.
  void draw(Ui& ui, Session& session, const RunProgress& progress);
  /// Whether it moves by itself.
  [[nodiscard]] bool lively() const;

 private:
  const Gl* gl_;
};

}  // namespace broadmark
