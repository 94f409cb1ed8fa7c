#pragma once

#include <fmt/format.h>

#include <string>

#include "scene/xml_document.h"

namespace parhelion {

/// Remembers the one element of a kind that a scene must have.
class OnlyElement {
public:
    explicit OnlyElement(std::string tag) : tag_(std::move(tag)) {}

    void set(const XmlElement& element) {
        if (element_)
            throw InputError(element.where, fmt::format("a scene has only one <{}>; the first is at {}", tag_,
                                                        element_->where.text()));
        element_ = &element;
    }

    const XmlElement& get(const XmlElement& root) const {
        if (!element_) throw InputError(root.where, fmt::format("the scene needs one <{}>", tag_));
        return *element_;
    }

private:
    std::string tag_;
    const XmlElement* element_ = nullptr;
};

}  // namespace parhelion
