#include "base/text_encoding.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace parhelion {
namespace {

using namespace std::string_view_literals;

struct Signature {
    std::string_view bytes, meaning;
};

constexpr std::string_view kUtf16 = "UTF-16 text: save it as UTF-8", kUtf32 = "UTF-32 text: save it as UTF-8";

// UTF-32's mark comes first: UTF-16's is the beginning of it.
constexpr std::array<Signature, 10> kSignatures{{
    {"\xff\xfe\0\0"sv, kUtf32},
    {"\0\0\xfe\xff"sv, kUtf32},
    {"\xff\xfe"sv, kUtf16},
    {"\xfe\xff"sv, kUtf16},
    {"\x1f\x8b"sv, "compressed by gzip: unpack it"},
    {"PK\x03\x04"sv, "a zip archive: unpack it"},
    {"BZh"sv, "compressed by bzip2: unpack it"},
    {"\xfd\x37zXZ\0"sv, "compressed by xz: unpack it"},
    {"\x28\xb5\x2f\xfd"sv, "compressed by zstd: unpack it"},
    {"7z\xbc\xaf\x27\x1c"sv, "a 7z archive: unpack it"},
}};

/// Whether every unit of `width` bytes holds an ASCII character in byte `place` and zeros else.
bool isWideAscii(std::string_view bytes, std::size_t width, std::size_t place) {
    constexpr std::size_t kExamined = 64;  // bytes, a multiple of both widths
    const std::size_t size = std::min(kExamined, bytes.size() / width * width);
    for (std::size_t i = 0; i < size; ++i)
        if ((i % width == place) != (bytes[i] > 0)) return false;
    return size > 0;
}

}  // namespace

std::string_view withoutByteOrderMark(std::string_view text) {
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
    return text;
}

std::string whyNotUtf8(std::string_view bytes) {
    for (const Signature& signature : kSignatures)
        if (bytes.starts_with(signature.bytes)) return std::string(signature.meaning);
    if (isWideAscii(bytes, 4, 0) || isWideAscii(bytes, 4, 3)) return std::string(kUtf32);
    if (isWideAscii(bytes, 2, 0) || isWideAscii(bytes, 2, 1)) return std::string(kUtf16);
    const std::size_t zero = bytes.find('\0');
    if (zero == std::string_view::npos) return {};
    return fmt::format("binary or damaged data: byte {} is 0", zero);
}

}  // namespace parhelion
