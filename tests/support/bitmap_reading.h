#pragma once

#include <string>

#include "base/error.h"
#include "image/bitmap.h"
#include "support/temporary_folder.h"

namespace parhelion::test {

/// Reads a bitmap from a file of that content.
inline Bitmap bitmapOf(const std::string& content, BitmapEncoding encoding = BitmapEncoding::kRaw) {
    const TemporaryFolder folder;
    return readBitmap(folder.write("picture", content), {"scene.xml", 1, 1}, encoding);
}

/// The error that reading ends with, from the file's name on ("picture:2:1: ..."); empty where there is none.
inline std::string bitmapError(const std::string& content) {
    try {
        bitmapOf(content);
        return "";
    } catch (const InputError& error) {
        const std::string text = error.what();
        return text.substr(text.find("picture"));
    }
}

/// All notes, a line each, from the file's name on.
inline std::string notesOf(const Bitmap& bitmap) {
    std::string text;
    for (const std::string& note : bitmap.notes) text += note.substr(note.find("picture")) + "\n";
    return text;
}

}  // namespace parhelion::test
