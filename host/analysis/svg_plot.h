#pragma once

#include <optional>
#include <string>
#include <vector>

namespace parhelion {

/// One curve of a plot: points from left to right, with a band where the values are uncertain.
struct PlotSeries {
    struct Point {
        double x = 0, y = 0;
        double lower = 0, upper = 0;  ///< of y; both 0: no band
    };
    std::string name;
    std::vector<Point> points;
    bool isDashed = false;
};

/// A horizontal line: a floor, a target.
struct PlotLine {
    std::string name;
    double y = 0;
};

/// A plot with logarithmic axes. Points that are not positive are left out.
struct LogPlot {
    std::string title, xName, yName;
    std::vector<PlotSeries> series;
    std::vector<PlotLine> lines;
    bool yIsShare = false;  ///< ticks in per cent
    bool xIsTime = false;   ///< ticks in seconds, minutes and hours
};

/// The plot as an SVG element, 720 x 440 units, that scales with its container and prints without colours too: curves
/// differ by their marks. Empty where nothing can be drawn.
std::string toSvg(const LogPlot& plot);

/// Text for HTML and SVG: the five characters that mean something there replaced.
std::string escapeMarkup(const std::string& text);

}  // namespace parhelion
