#include "analysis/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace parhelion {
namespace {

constexpr double kWidth = 720, kHeight = 440, kLeft = 66, kRight = 16, kTop = 16, kBottom = 50;
// Okabe and Ito's colours, which most colour-blind readers tell apart, from dark to light.
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"};
constexpr const char* kMarks[] = {"<circle cx='0' cy='0' r='3.5'/>",
                                  "<rect x='-3.2' y='-3.2' width='6.4' height='6.4'/>",
                                  "<path d='M0-4.4 4 3-4 3z'/>",
                                  "<path d='M0-4.6 4.6 0 0 4.6-4.6 0z'/>",
                                  "<path d='M-4-3 4-3 0 4.4z'/>",
                                  "<path d='M-4-1.2h2.8V-4h2.4v2.8H4v2.4H1.2V4h-2.4V1.2H-4z'/>",
                                  "<rect x='-4.5' y='-1.5' width='9' height='3'/>"};

/// Bounds of positive values, widened to something to look at.
struct Range {
    double from = std::numeric_limits<double>::infinity(), to = 0;

    void add(double value) {
        if (!(value > 0) || !std::isfinite(value)) return;
        from = std::min(from, value);
        to = std::max(to, value);
    }
    bool isEmpty() const { return !(to > 0); }
    void widen() {
        const double margin = std::max(1.1, std::pow(to / from, 0.05));
        from /= margin;
        to *= margin;
        if (to / from < 4) from /= 2, to *= 2;
    }
};

struct Frame {
    Range x, y;

    double right(double value) const {
        return kLeft + (kWidth - kLeft - kRight) * std::log(value / x.from) / std::log(x.to / x.from);
    }
    double down(double value) const {
        return kHeight - kBottom - (kHeight - kTop - kBottom) * std::log(value / y.from) / std::log(y.to / y.from);
    }
};

std::string share(double value) { return fmt::format("{:.3g} %", 100 * value); }

std::string duration(double seconds) {
    if (seconds < 0.9995) return fmt::format("{:.3g} ms", 1000 * seconds);
    if (seconds < 59.5) return fmt::format("{:.3g} s", seconds);
    if (seconds < 3570) return fmt::format("{:.3g} min", seconds / 60);
    return fmt::format("{:.3g} h", seconds / 3600);
}

/// Ticks at round values: those of a clock, or 1, 2 and 5 times powers of ten; one each power where there are many.
std::vector<double> ticks(const Range& range, bool isTime) {
    static constexpr double kClock[] = {1, 3, 10, 30, 60, 180, 600, 1800, 3600, 10800, 36000, 86400};
    std::vector<double> all;
    if (isTime && range.from >= 0.3) {
        for (const double value : kClock)
            if (value >= range.from && value <= range.to) all.push_back(value);
        if (all.size() >= 2) return all;
        all.clear();
    }
    const double decades = std::log10(range.to / range.from);
    for (double power = std::pow(10, std::floor(std::log10(range.from))); power <= range.to; power *= 10)
        for (const double factor : {1.0, 2.0, 5.0}) {
            if (factor != 1 && decades > 3) continue;
            const double value = factor * power;
            if (value >= range.from && value <= range.to) all.push_back(value);
        }
    return all;
}

std::string axes(const LogPlot& plot, const Frame& frame) {
    std::string svg;
    const double bottom = kHeight - kBottom, end = kWidth - kRight;
    for (const double x : ticks(frame.x, plot.xIsTime)) {
        const double at = frame.right(x);
        svg += fmt::format("<path class='grid' d='M{:.1f} {}V{}'/>", at, kTop, bottom);
        svg += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>", at, bottom + 18,
                           plot.xIsTime ? duration(x) : fmt::format("{:g}", x));
    }
    for (const double y : ticks(frame.y, false)) {
        const double at = frame.down(y);
        svg += fmt::format("<path class='grid' d='M{} {:.1f}H{}'/>", kLeft, at, end);
        svg += fmt::format("<text x='{}' y='{:.1f}' text-anchor='end'>{}</text>", kLeft - 7, at + 4,
                           plot.yIsShare ? share(y) : fmt::format("{:g}", y));
    }
    svg += fmt::format("<text x='{}' y='{}' text-anchor='middle'>{}</text>", (kLeft + end) / 2, kHeight - 10,
                       escapeMarkup(plot.xName));
    svg += fmt::format("<text transform='translate(15 {}) rotate(-90)' text-anchor='middle'>{}</text>",
                       (kTop + bottom) / 2, escapeMarkup(plot.yName));
    return svg;
}

std::string curve(const PlotSeries& series, const Frame& frame, std::size_t index) {
    std::string band, back, line, marks;
    const char* color = kColors[index % std::size(kColors)];
    for (const PlotSeries::Point& p : series.points) {
        if (!(p.x > 0) || !(p.y > 0) || !std::isfinite(p.x) || !std::isfinite(p.y)) continue;
        const double x = frame.right(p.x), y = frame.down(p.y);
        line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", x, y);
        marks += fmt::format("<g transform='translate({:.1f} {:.1f})'>{}</g>", x, y, kMarks[index % std::size(kMarks)]);
        if (!(p.lower > 0) || !(p.upper > 0)) continue;
        band += fmt::format("{}{:.1f} {:.1f}", band.empty() ? "M" : "L", x, frame.down(p.upper));
        back = fmt::format("L{:.1f} {:.1f}", x, frame.down(p.lower)) + back;
    }
    std::string svg;
    if (!band.empty()) svg += fmt::format("<path d='{}{}z' fill='{}' fill-opacity='.15'/>", band, back, color);
    svg += fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='1.8'{}/>", line, color,
                       series.isDashed ? " stroke-dasharray='5 4'" : "");
    return svg + fmt::format("<g fill='{}'>{}</g>", color, marks);
}

std::string legend(const LogPlot& plot) {
    std::string svg;
    double y = kTop + 14;
    for (std::size_t i = 0; i < plot.series.size(); ++i, y += 17) {
        const double x = kWidth - kRight - 12;
        svg += fmt::format("<g transform='translate({} {})' fill='{}'>{}</g>", x, y - 4,
                           kColors[i % std::size(kColors)], kMarks[i % std::size(kMarks)]);
        svg += fmt::format("<text x='{}' y='{}' text-anchor='end'>{}</text>", x - 10, y,
                           escapeMarkup(plot.series[i].name));
    }
    return svg;
}

}  // namespace

std::string escapeMarkup(const std::string& text) {
    std::string escaped;
    for (const char c : text) switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\'':
                escaped += "&#39;";
                break;
            default:
                escaped += c;
        }
    return escaped;
}

std::string toSvg(const LogPlot& plot) {
    Frame frame;
    for (const PlotSeries& series : plot.series)
        for (const PlotSeries::Point& p : series.points) {
            if (!(p.y > 0) || !(p.x > 0)) continue;
            frame.x.add(p.x);
            for (const double y : {p.y, p.lower, p.upper}) frame.y.add(y);
        }
    if (frame.x.isEmpty() || frame.y.isEmpty()) return "";
    for (const PlotLine& line : plot.lines) frame.y.add(line.y);
    frame.x.widen();
    frame.y.widen();
    std::string svg = fmt::format("<svg class='plot' viewBox='0 0 {} {}' role='img' aria-label='{}'>", kWidth, kHeight,
                                  escapeMarkup(plot.title));
    svg += axes(plot, frame);
    for (const PlotLine& line : plot.lines) {
        if (!(line.y > 0)) continue;
        const double y = frame.down(line.y);
        svg += fmt::format("<path class='line' d='M{} {:.1f}H{}'/><text x='{}' y='{:.1f}'>{}</text>", kLeft, y,
                           kWidth - kRight, kLeft + 6, y - 5, escapeMarkup(line.name));
    }
    for (std::size_t i = 0; i < plot.series.size(); ++i) svg += curve(plot.series[i], frame, i);
    if (plot.series.size() > 1) svg += legend(plot);
    return svg + "</svg>";
}

}  // namespace parhelion
