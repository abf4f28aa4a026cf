// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/text_rows.h"

#include <algorithm>
#include <istream>
#include <streambuf>
#include <vector>

#include "simulate/core/check.h"
#include "simulate/core/input_file.h"
#include "simulate/core/text.h"

namespace flocklift::internal {
namespace {

constexpr std::size_t kLook = 512;                       // bytes, for a row at first
constexpr std::size_t kFarthest = std::size_t{1} << 20;  // where no row is found nearer
constexpr std::size_t kLongestHead = std::size_t{1} << 16;
constexpr std::size_t kBlock = std::size_t{1} << 16;

// The frame that a row begins with; nothing when it begins otherwise.
std::optional<int> FrameOf(std::string_view line) {
  const std::size_t comma = line.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const std::optional<std::int64_t> frame = ParseInteger(Trim(line.substr(0, comma)));
  if (!frame || *frame < 1 || *frame > kMaxFrame) return std::nullopt;
  return static_cast<int>(*frame);
}

bool BeginsWithFrame(std::string_view header) {
  const std::string_view name = Trim(header.substr(0, header.find(',')));
  return name == "frame" || name == "\"frame\"";
}

// The bytes [begin, end) of a file, read as a stream of its own.
class SpanBuffer : public std::streambuf {
 public:
  SpanBuffer(std::ifstream* file, std::uint64_t begin, std::uint64_t end)
      : file_(file), left_(end - begin), block_(kBlock) {
    file_->clear();
    file_->seekg(static_cast<std::streamoff>(begin));
  }

 protected:
  int_type underflow() override {
    const std::size_t count = std::min<std::uint64_t>(left_, block_.size());
    file_->read(block_.data(), static_cast<std::streamsize>(count));
    const auto got = static_cast<std::size_t>(file_->gcount());
    left_ = got == count ? left_ - got : 0;
    setg(block_.data(), block_.data(), block_.data() + got);
    return got == 0 ? traits_type::eof() : traits_type::to_int_type(block_.front());
  }

 private:
  std::ifstream* file_;
  std::uint64_t left_;
  std::vector<char> block_;
};

}  // namespace

TextRows::TextRows(const std::filesystem::path& path)
    : name_(path.string()), stream_(OpenInput(path)) {
  stream_.seekg(0, std::ios::end);
  size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(stream_.tellg(), 0));
}

std::string_view TextRows::Bytes(std::uint64_t begin, std::size_t count) {
  buffer_.resize(std::max(buffer_.size(), count));
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(begin));
  stream_.read(buffer_.data(), static_cast<std::streamsize>(count));
  if (stream_.bad()) throw InputError(name_, 0, "cannot be read to its end", "check the disk");
  return {buffer_.data(), static_cast<std::size_t>(stream_.gcount())};
}

std::optional<TextHead> TextRows::ReadHead(bool has_header) {
  const std::string_view bytes = Bytes(0, kLongestHead);
  TextHead head;
  while (true) {
    const std::size_t end = bytes.find('\n', head.end);
    std::string_view line = bytes.substr(head.end, end - head.end);
    if (head.end == 0 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    line = line.ends_with('\r') ? Trim(line.substr(0, line.size() - 1)) : Trim(line);
    const bool is_plain = line.empty() || line.front() == '#';
    if (!is_plain && !has_header) {
      if (!FrameOf(line)) return std::nullopt;
      break;
    }
    if (!is_plain) {
      if (!BeginsWithFrame(line)) return std::nullopt;
      has_header = false;
    }
    if (end == std::string_view::npos) return std::nullopt;
    head.end = end + 1;
    ++head.lines;
  }
  head.text = bytes.substr(0, head.end);
  return head;
}

std::optional<PlacedRow> TextRows::From(std::uint64_t at) {
  // A line begins behind a newline, which may be the byte before.
  const std::uint64_t first = at > 0 ? at - 1 : 0;
  for (std::size_t look = kLook;; look = std::min(8 * look, kFarthest)) {
    const std::string_view bytes = Bytes(first, look);
    const bool is_all = bytes.size() < look;
    std::size_t begin = at > 0 ? bytes.find('\n') + 1 : 0;
    if (at > 0 && begin == 0) begin = bytes.size();
    while (begin < bytes.size()) {
      const std::size_t end = bytes.find('\n', begin);
      if (end == std::string_view::npos && !is_all) break;
      if (const auto frame = FrameOf(bytes.substr(begin, end - begin))) {
        return PlacedRow{first + begin, *frame};
      }
      if (end == std::string_view::npos) break;
      begin = end + 1;
    }
    if (is_all || look == kFarthest) return std::nullopt;
  }
}

long TextRows::CountLines(std::uint64_t end) {
  long lines = 0;
  for (std::uint64_t at = 0; at < end; at += kFarthest) {
    const std::string_view bytes =
        Bytes(at, static_cast<std::size_t>(std::min<std::uint64_t>(kFarthest, end - at)));
    lines += std::count(bytes.begin(), bytes.end(), '\n');
  }
  return lines;
}

TableContents TextRows::Read(const TextHead& head, std::uint64_t begin, std::uint64_t end,
                             long lines_before, const TableLayout& layout, const TakeRow& take) {
  SpanBuffer buffer(&stream_, begin, std::max(begin, end));
  std::istream rows(&buffer);
  return ReadCsvTable(rows, name_, layout, take, {.head = head.text, .lines_before = lines_before});
}

}  // namespace flocklift::internal
