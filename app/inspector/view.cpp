#include "app/inspector/view.h"

namespace broadmark {

View::View(const Gl& gl) : gl_(&gl) {}
View::~View() = default;
void View::draw(Ui&, Session&, const RunProgress&) {}
bool View::lively() const { return false; }

}  // namespace broadmark
