#pragma once

#include <string>

#include "figures.h"

namespace isolux::bench {

/// The plot as an SVG picture of its own: light ground, grid, error bars, legend beside the axes, a colour and a mark
/// for each series (the palette of Okabe & Ito 2008, which the colour-blind can tell apart). Points that a logarithmic
/// axis cannot show are left out. Series without points are left out of the legend.
[[nodiscard]] std::string svg(const Plot& plot);

}  // namespace isolux::bench
