// The list of panels.

#include "inspector/panels/panel.h"

namespace broadmark {

#define PANEL(name)                   \
  namespace panels::name {            \
  std::unique_ptr<Panel> makePanel(); \
  }
#include "inspector_panels.inc"
#undef PANEL

std::vector<std::unique_ptr<Panel>> makePanels() {
  std::vector<std::unique_ptr<Panel>> made;
#define PANEL(name) made.push_back(panels::name::makePanel());
#include "inspector_panels.inc"
#undef PANEL
  return made;
}

}  // namespace broadmark
