// The colour bar beside a picture whose bodies show a field.
#pragma once
#include "engine/frame/frame.h"
#include "render/image.h"

namespace sherd {

// At the left, half the picture's height, the range's ends beside it. Left out where the picture is too small for it.
void draw_legend(const FieldScale& scale, Image& image);

// "1.25 MPa": three digits with an SI prefix; "0 J/m3".
std::string legend_number(Real value, const std::string& unit);

}  // namespace sherd
