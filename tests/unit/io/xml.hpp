#pragma once
// A small strict reader of XML, enough to check what the writers produce.

#include <cctype>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

struct XmlTag {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string parents;  ///< names from the root, e.g. "VTKFile/PolyData/"

  [[nodiscard]] const std::string& at(const std::string& attribute) const { return attributes.at(attribute); }
};

/// The opening tags of `xml` in order. Throws std::runtime_error where it is not well formed: tags that do not match,
/// attributes without quotes or twice, a bare '&' or '<'. Void HTML tags (meta, img) may stay open.
class XmlReader {
 public:
  static std::vector<XmlTag> tags(std::string_view xml) {
    XmlReader reader(xml);
    while (reader.step()) {
    }
    if (!reader.open_.empty()) reader.refuse("open at the end: " + reader.open_.back());
    return reader.tags_;
  }

 private:
  explicit XmlReader(std::string_view xml) : xml_(xml) {
    for (const std::string_view prolog : {"<?xml version=\"1.0\"?>", "<!DOCTYPE html>"}) {
      if (xml_.substr(0, prolog.size()) == prolog) at_ = prolog.size();
    }
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw std::runtime_error("XML at " + std::to_string(at_) + ": " + why);
  }

  void check_entities(std::string_view text) const {
    for (std::size_t i = text.find('&'); i != std::string_view::npos; i = text.find('&', i + 1)) {
      bool known = false;
      for (const std::string_view entity : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"}) {
        known = known || text.substr(i, entity.size()) == entity;
      }
      if (!known) refuse("bare &");
    }
    if (text.find('<') != std::string_view::npos) refuse("bare <");
  }

  std::string_view until(char end) {
    const auto stop = xml_.find(end, at_);
    if (stop == std::string_view::npos) refuse(std::string("no ") + end);
    const auto text = xml_.substr(at_, stop - at_);
    at_ = stop + 1;
    return text;
  }

  std::string name() {
    std::string text;
    while (at_ < xml_.size() &&
           (std::isalnum(static_cast<unsigned char>(xml_[at_])) != 0 || xml_[at_] == '-' || xml_[at_] == '_')) {
      text += xml_[at_++];
    }
    if (text.empty()) refuse("no name");
    return text;
  }

  void skip_spaces() {
    while (at_ < xml_.size() && std::isspace(static_cast<unsigned char>(xml_[at_])) != 0) ++at_;
  }

  bool step() {
    const auto next = xml_.find('<', at_);
    check_entities(xml_.substr(at_, next == std::string_view::npos ? next : next - at_));
    if (next == std::string_view::npos) return false;
    at_ = next + 1;
    if (xml_[at_] == '/') {
      ++at_;
      const std::string closed(until('>'));
      if (open_.empty() || open_.back() != closed) refuse("</" + closed + "> closes nothing");
      open_.pop_back();
      return true;
    }
    XmlTag tag;
    for (const auto& parent : open_) tag.parents += parent + "/";
    tag.name = name();
    for (skip_spaces(); xml_[at_] != '>' && xml_[at_] != '/'; skip_spaces()) {
      const std::string key = name();
      if (until('"') != "=") refuse("no =\" after " + key);
      const std::string value(until('"'));
      check_entities(value);
      if (!tag.attributes.emplace(key, value).second) refuse("twice: " + key);
    }
    const bool closed = xml_[at_] == '/' || tag.name == "meta" || tag.name == "img";
    if (xml_[at_] == '/') ++at_;
    if (xml_[at_++] != '>') refuse("no > after " + tag.name);
    if (!closed) open_.push_back(tag.name);
    tags_.push_back(std::move(tag));
    return true;
  }

  std::string_view xml_;
  std::size_t at_ = 0;
  std::vector<std::string> open_;
  std::vector<XmlTag> tags_;
};
