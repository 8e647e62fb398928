#include "scene_text.h"

#include <yaml-cpp/eventhandler.h>

#include <map>
#include <set>
#include <sstream>
#include <vector>

#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kDeepest =
    100;  // a scene has ten; what is deeper than the stack ends a program
constexpr const char* kAllowedText =
    "must be YAML: indented by blanks, never tabs, a blank after each colon, every bracket closed";

// What is YAML, but refused.
class Refusal : public YAML::ParserException {
 public:
  using YAML::ParserException::ParserException;
};

// Counts the values of a document as a reader meets them: aliases of aliases stand for more values
// than any memory holds, and one that stands within itself for no end of them.
class ValueCounter : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { addLeaf(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                const std::string&) override {
    addLeaf(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (open_.count(anchor) > 0) {
      throw Refusal(mark, "an alias stands within what it stands for, must not");
    }
    add(mark, values_.count(anchor) > 0 ? values_.at(anchor) : 1.0);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(mark, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(mark, anchor);
  }
  void OnMapEnd() override { end(); }

 private:
  struct Collection {
    YAML::anchor_t anchor;
    double before;  // values counted before it
  };

  void add(const YAML::Mark& mark, double values) {
    count_ += values;
    if (count_ > kMostValues) {
      throw Refusal(mark, "has more than " + numberText(kMostValues) +
                              " values, aliases counted as what they stand for, must have fewer");
    }
  }
  void addLeaf(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (anchor != 0) values_[anchor] = 1.0;
    add(mark, 1.0);
  }
  void begin(const YAML::Mark& mark, YAML::anchor_t anchor) {
    collections_.push_back({anchor, count_});
    if (collections_.size() > kDeepest) {
      throw Refusal(mark, "lists and maps stand in one another more than " +
                              std::to_string(kDeepest) + " deep, must not");
    }
    if (anchor != 0) open_.insert(anchor);
    add(mark, 1.0);
  }
  void end() {
    const Collection ended = collections_.back();
    collections_.pop_back();
    open_.erase(ended.anchor);
    if (ended.anchor != 0) values_[ended.anchor] = count_ - ended.before;
  }

  double count_ = 0.0;
  std::vector<Collection> collections_;
  std::set<YAML::anchor_t> open_;
  std::map<YAML::anchor_t, double> values_;
};

void requireFewValues(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  ValueCounter counter;
  while (parser.HandleNextDocument(counter)) {
  }
}

[[noreturn]] void refuse(const std::string& source, const YAML::Exception& error,
                         const std::string& why) {
  const std::string at = error.mark.is_null() ? "" : ":" + std::to_string(error.mark.line + 1);
  throw InputError(onOneLine(source) + at + ": " + why);
}

}  // namespace

YAML::Node parseYaml(const std::string& text, const std::string& source) {
  try {
    requireFewValues(text);
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) {
      throw InputError(onOneLine(source) + ": has " + std::to_string(documents.size()) +
                       " YAML documents, must have one");
    }
    return documents.empty() ? YAML::Node() : documents.front();
  } catch (const Refusal& error) {
    refuse(source, error, error.msg);
  } catch (const YAML::Exception& error) {
    refuse(source, error, "not YAML: " + onOneLine(error.msg) + ", " + kAllowedText);
  }
}

}  // namespace robot_tissue
