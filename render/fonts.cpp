#include "broadmark/render/fonts.h"

#include "render_assets.h"

namespace broadmark {

std::string_view interfaceFont() { return render_assets::Inter_Regular_otf(); }

}  // namespace broadmark
