// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include <iterator>

#include "simulate/core/check.h"
#include "simulate/core/fps.h"
#include "simulate/core/number_text.h"
#include "simulate/core/table_writer.h"
#include "simulate/core/text_writer.h"

namespace flocklift::internal {
namespace {

class CsvWriter : public TableWriter {
 public:
  CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns,
            bool has_header, std::optional<double> fps, const TextStyle& style)
      : writer_(path), style_(style), column_count_(columns.size()) {
    auto out = std::back_inserter(writer_.buffer());
    if (fps) fmt::format_to(out, "# fps={}\n", FormatFps(*fps));
    if (has_header) {
      fmt::format_to(out, "frame,id");
      for (const std::string& column : columns) fmt::format_to(out, ",{}", column);
      fmt::format_to(out, "\n");
    }
  }

  void Add(int frame, Id id, std::span<const double> values, std::string_view end_of_row) override {
    FLOCKLIFT_DCHECK(values.size() == column_count_);
    fmt::memory_buffer& text = writer_.buffer();
    AppendInteger(frame, &text);
    text.push_back(',');
    AppendInteger(id, &text);
    for (const double value : values) {
      text.push_back(',');
      if (style_.decimals < 0) {
        AppendNineDigits(value, &text);
      } else {
        AppendFixed(value, style_.decimals, &text);
      }
    }
    const std::string_view end =
        end_of_row.empty() ? std::string_view(style_.end_of_row) : end_of_row;
    text.append(end.data(), end.data() + end.size());
    text.push_back('\n');
    writer_.FlushIfFull();
  }

  void Commit() override { writer_.Commit(); }

 private:
  TextWriter writer_;
  TextStyle style_;
  [[maybe_unused]] std::size_t column_count_;
};

}  // namespace

std::unique_ptr<TableWriter> CreateCsvWriter(const std::filesystem::path& path,
                                             const std::vector<std::string>& columns,
                                             bool has_header, std::optional<double> fps,
                                             const TextStyle& style) {
  return std::make_unique<CsvWriter>(path, columns, has_header, fps, style);
}

}  // namespace flocklift::internal
