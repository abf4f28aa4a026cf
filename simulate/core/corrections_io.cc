// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <span>

#include "simulate/core/check.h"
#include "simulate/core/input_file.h"
#include "simulate/core/io.h"
#include "simulate/core/line_reader.h"
#include "simulate/core/suggest.h"
#include "simulate/core/table.h"
#include "simulate/core/text.h"

namespace flocklift {
namespace {

enum class Argument { kId, kOtherId, kFirstFrame, kLastFrame, kX, kY };

struct Operation {
  const char* name;
  Correction::Kind kind;
  const char* usage;
  std::vector<Argument> arguments;
  std::size_t fewest_arguments;
};

const std::array<Operation, 6>& Operations() {
  using enum Argument;
  static const std::array<Operation, 6> operations{{
      {"swap", Correction::Kind::kSwap, "swap ID ID FRAME", {kId, kOtherId, kFirstFrame}, 3},
      {"split", Correction::Kind::kSplit, "split ID FRAME", {kId, kFirstFrame}, 2},
      {"join", Correction::Kind::kJoin, "join ID ID", {kId, kOtherId}, 2},
      {"delete",
       Correction::Kind::kDelete,
       "delete ID [FIRST LAST]",
       {kId, kFirstFrame, kLastFrame},
       1},
      {"pin", Correction::Kind::kPin, "pin ID FRAME X Y", {kId, kFirstFrame, kX, kY}, 4},
      {"add", Correction::Kind::kAdd, "add FRAME X Y", {kFirstFrame, kX, kY}, 3},
  }};
  return operations;
}

std::vector<std::string_view> SplitWords(std::string_view line) {
  std::vector<std::string_view> words;
  while (!(line = Trim(line)).empty()) {
    const std::size_t end = std::min(line.find(' '), line.find('\t'));
    words.push_back(line.substr(0, end));
    line.remove_prefix(words.back().size());
  }
  return words;
}

class LineParser {
 public:
  LineParser(const std::string& name, long line) : place_{.file = name, .is_text = true} {
    row_.place = &place_;
    row_.line = line;
  }

  Correction Parse(std::span<const std::string_view> words) const {
    const Operation& operation = Find(words.front());
    const std::string usage = fmt::format("write {}", operation.usage);
    words = words.subspan(1);
    const std::size_t most = operation.arguments.size();
    if (words.size() != most && words.size() != operation.fewest_arguments) {
      row_.Fail(fmt::format("{} has {} arguments", operation.name, words.size()), usage);
    }
    Correction correction;
    correction.kind = operation.kind;
    correction.line = static_cast<int>(row_.line);
    for (std::size_t k = 0; k < words.size(); ++k) {
      ParseArgument(operation.arguments[k], words[k], usage, &correction);
    }
    if (correction.id == correction.other_id && correction.id != 0) {
      row_.Fail(fmt::format("id {} stands twice", correction.id), "name two animals");
    }
    if (correction.last_frame != 0 && correction.last_frame < correction.first_frame) {
      row_.Fail(
          fmt::format("frame {} is before frame {}", correction.last_frame, correction.first_frame),
          "give the first frame first");
    }
    return correction;
  }

 private:
  const Operation& Find(std::string_view word) const {
    std::vector<std::string> names;
    for (const Operation& operation : Operations()) {
      if (word == operation.name) return operation;
      names.emplace_back(operation.name);
    }
    row_.Fail(fmt::format("there is no operation {}", Quoted(word)), SuggestName(word, names));
  }

  void ParseArgument(Argument argument, std::string_view word, const std::string& usage,
                     Correction* correction) const {
    switch (argument) {
      case Argument::kId:
        correction->id = internal::CheckedId(row_, Whole(word, usage), false);
        break;
      case Argument::kOtherId:
        correction->other_id = internal::CheckedId(row_, Whole(word, usage), false);
        break;
      case Argument::kFirstFrame:
        correction->first_frame = internal::CheckedFrame(row_, Whole(word, usage));
        break;
      case Argument::kLastFrame:
        correction->last_frame = internal::CheckedFrame(row_, Whole(word, usage));
        break;
      case Argument::kX:
        correction->point.x = Pixels(word, "X", usage);
        break;
      case Argument::kY:
        correction->point.y = Pixels(word, "Y", usage);
        break;
    }
  }

  std::int64_t Whole(std::string_view word, const std::string& usage) const {
    const std::optional<std::int64_t> value = ParseInteger(word);
    if (!value) row_.Fail(fmt::format("{} is not a whole number", Quoted(word)), usage);
    return *value;
  }

  double Pixels(std::string_view word, const char* name, const std::string& usage) const {
    const std::optional<double> value = ParseReal(word);
    if (!value) row_.Fail(fmt::format("{} is not a finite number", Quoted(word)), usage);
    internal::CheckMagnitude(row_, name, *value);
    return *value;
  }

  internal::TablePlace place_;
  internal::TableRow row_;
};

}  // namespace

std::vector<Correction> ReadCorrections(std::istream& stream, const std::string& name) {
  std::vector<Correction> corrections;
  LineReader reader(stream, name);
  std::string_view line;
  while (reader.Next(&line)) {
    const std::vector<std::string_view> words = SplitWords(line.substr(0, line.find('#')));
    if (words.empty()) continue;
    corrections.push_back(LineParser(name, reader.line()).Parse(words));
  }
  return corrections;
}

std::vector<Correction> ReadCorrections(const std::filesystem::path& path) {
  std::ifstream stream = OpenInput(path);
  return ReadCorrections(stream, path.string());
}

}  // namespace flocklift
