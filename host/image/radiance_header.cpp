#include "image/radiance_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

namespace parhelion {

namespace {

std::string_view textOf(std::span<const std::byte> content) {
    return {reinterpret_cast<const char*>(content.data()), content.size()};
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r";
    const std::size_t first = text.find_first_not_of(kBlanks);
    return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string_view> wordsOf(std::string_view text) {
    std::vector<std::string_view> words;
    for (text = trimmed(text); !text.empty();) {
        const std::size_t length = std::min(text.find_first_of(" \t"), text.size());
        words.push_back(text.substr(0, length));
        text = trimmed(text.substr(length));
    }
    return words;
}

std::optional<double> numberOf(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// For messages: a damaged file's line may be long, and hold anything.
std::string quoted(std::string_view text) {
    std::string result;
    for (const char c : text.substr(0, 60)) result += c >= 0x20 && c < 0x7f ? c : '?';
    return "\"" + result + (text.size() > 60 ? "...\"" : "\"");
}

constexpr std::string_view kRgbe = "32-bit_rle_rgbe", kXyze = "32-bit_rle_xyze";
/// The divisors beyond which floats keep nothing of a picture.
constexpr double kMaxDivisor = 1e30;

class HeaderReader {
public:
    HeaderReader(const BitmapFile& file, Bitmap& remarks)
        : file_(file), remarks_(remarks), text_(textOf(file.content)) {}

    RadianceHeader read() {
        std::string_view text;
        while (!trimmed(text = nextLine("an empty line")).empty()) readVariable(text);
        readResolution(nextLine("the line of the resolution, such as \"-Y 512 +X 1024\""));
        header_.begin = at_;
        if (format_.empty()) note(0, fmt::format("has no FORMAT; {} is assumed", kRgbe));
        noteDivisor();
        if (header_.isXyz && header_.space) {
            note(header_.spaceLine, "PRIMARIES has no effect on X, Y and Z");
            header_.space.reset();
        }
        return header_;
    }

private:
    [[noreturn]] void fail(const std::string& message) const { file_.fail(message, line_); }
    void note(int line, const std::string& message) { file_.note(remarks_, message, line); }

    std::string_view nextLine(const std::string& wanted) {
        const std::size_t end = text_.find('\n', at_);
        if (end == std::string_view::npos)
            file_.fail(fmt::format("must be a whole .hdr file; its header ends before {}", wanted));
        const std::string_view line = text_.substr(at_, end - at_);
        at_ = end + 1;
        ++line_;
        return line;
    }

    /// Variables begin their line: what is indented was said of another picture, which this one was made from.
    void readVariable(std::string_view line) {
        const std::size_t equals = line.find('=');
        if (equals == std::string_view::npos) return;
        const std::string_view name = line.substr(0, equals), value = trimmed(line.substr(equals + 1));
        if (name == "FORMAT") readFormat(value);
        if (name == "EXPOSURE") multiplyDivisor(name, value, 1);
        if (name == "COLORCORR") multiplyDivisor(name, value, 3);
        if (name == "PRIMARIES") readPrimaries(value);
        bool& isNoted = name == "GAMMA" ? isGammaNoted_ : isAspectNoted_;
        if ((name == "PIXASPECT" || name == "GAMMA") && numberOf(value) != 1.0 && !std::exchange(isNoted, true))
            note(line_, fmt::format("{} has no effect", quoted(trimmed(line))));
    }

    void readFormat(std::string_view value) {
        if (value != kRgbe && value != kXyze)
            fail(fmt::format("FORMAT must be {} or {}; got {}", kRgbe, kXyze, quoted(value)));
        if (!format_.empty() && format_ != value)
            fail(fmt::format("FORMAT must be given once; got {} after {}", value, format_));
        format_ = value;
        header_.isXyz = value == kXyze;
    }

    std::vector<double> numbers(std::string_view name, std::string_view value, std::size_t count) const {
        std::vector<double> result;
        for (const std::string_view word : wordsOf(value))
            if (const auto number = numberOf(word)) result.push_back(*number);
        if (result.size() != count || wordsOf(value).size() != count)
            fail(fmt::format("{} must be {} number{}; got {}", name, count, count == 1 ? "" : "s", quoted(value)));
        return result;
    }

    void multiplyDivisor(std::string_view name, std::string_view value, std::size_t count) {
        const std::vector<double> factors = numbers(name, value, count);
        for (int channel = 0; channel < 3; ++channel) {
            const double factor = factors[count == 1 ? 0 : std::size_t(channel)];
            double& product = header_.divisor[channel];
            product *= factor;
            if (!(factor > 0.0)) fail(fmt::format("{} must be > 0; got {}", name, quoted(value)));
            if (!(product >= 1.0 / kMaxDivisor && product <= kMaxDivisor))
                fail(fmt::format("EXPOSURE and COLORCORR must multiply to [{:g}, {:g}]; got {:g}", 1.0 / kMaxDivisor,
                                 kMaxDivisor, product));
        }
        divisorLine_ = line_;
    }

    void noteDivisor() {
        const glm::dvec3 d = header_.divisor;
        if (d == glm::dvec3(1.0)) return;
        const std::string amount =
            d.x == d.y && d.y == d.z ? fmt::format("{:g}", d.x) : fmt::format("({:g}, {:g}, {:g})", d.x, d.y, d.z);
        note(divisorLine_,
             fmt::format("EXPOSURE and COLORCORR multiply to {}: texels are divided by it, which gives the "
                         "radiance; Mitsuba takes them undivided",
                         amount));
    }

    void readPrimaries(std::string_view value) {
        const std::vector<double> n = numbers("PRIMARIES", value, 8);
        const bool allZero = std::ranges::all_of(n, [](double number) { return number == 0.0; });
        if (allZero) {
            // Photoshop writes that into every file.
            header_.space.reset();
            return;
        }
        header_.space = Chromaticities{{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}};
        header_.spaceLine = line_;
    }

    RadianceHeader::Axis axisOf(std::string_view sign, std::string_view size, std::string_view line) const {
        const auto isOneOf = [sign](const char* a, const char* b) { return sign == a || sign == b; };
        RadianceHeader::Axis axis{isOneOf("+Y", "-Y"), sign.starts_with('-'), 0};
        const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), axis.size);
        const bool isTooLarge = error == std::errc::result_out_of_range;
        if (isTooLarge) axis.size = ~std::uint64_t{0};
        if ((!axis.isY && !isOneOf("+X", "-X")) || end != size.data() + size.size() ||
            (error != std::errc() && !isTooLarge))
            failResolution(line);
        return axis;
    }

    [[noreturn]] void failResolution(std::string_view line) const {
        fail(
            fmt::format("the line of the resolution must be two of \"-Y height\", \"+Y height\", \"-X width\" and \"+X "
                        "width\"; got {}",
                        quoted(trimmed(line))));
    }

    void readResolution(std::string_view line) {
        const std::vector<std::string_view> words = wordsOf(line);
        if (words.size() != 4) failResolution(line);
        header_.scanlines = axisOf(words[0], words[1], line);
        header_.pixels = axisOf(words[2], words[3], line);
        if (header_.scanlines.isY == header_.pixels.isY) failResolution(line);
    }

    const BitmapFile& file_;
    Bitmap& remarks_;
    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 0;
    bool isGammaNoted_ = false, isAspectNoted_ = false;  ///< the first such line stands for all
    std::string_view format_;
    int divisorLine_ = 0;
    RadianceHeader header_;
};

}  // namespace

bool isRadiance(std::span<const std::byte> content) {
    constexpr std::size_t kSearched = 4096;  // of a header without the first line that all programs write today
    const std::string_view text = textOf(content);
    if (text.starts_with("#?")) return true;
    const std::string_view start = text.substr(0, kSearched);
    return start.starts_with("FORMAT=32-bit_rle_") || start.find("\nFORMAT=32-bit_rle_") != std::string_view::npos;
}

RadianceHeader readRadianceHeader(const BitmapFile& file, Bitmap& remarks) {
    return HeaderReader(file, remarks).read();
}

}  // namespace parhelion
