// TextScanner: the words of a text file, line by line. Private to voxelizer/io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace xorvox::io {

/// Walks over text that it borrows. Words are separated by blanks, tabs and carriage returns.
class TextScanner {
public:
    enum class Dialect : std::uint8_t {
        Plain,
        Obj,  ///< A word that begins with # ends the line; a backslash before a newline continues it.
    };

    explicit TextScanner(std::string_view text, Dialect dialect = Dialect::Plain, std::size_t first_line = 1)
        : at_(text.data()), end_(text.data() + text.size()), line_(first_line), obj_(dialect == Dialect::Obj) {}

    /// Moves past blanks, empty lines and comments, to the next word; false at the end of the text. Must be called
    /// before the first word(), and again when word() is empty.
    bool next_line();
    /// The next word of this line; empty at its end.
    std::string_view word();
    /// Moves to the end of this line, whatever it says; a backslash does not continue it.
    void skip_line();

    /// What is left of this line, without the blanks around it; moves to its end.
    std::string_view rest_of_line();

    std::size_t line() const { return line_; }
    std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

private:
    const char* continuation(const char* at) const;
    void skip_blanks();

    const char* at_;
    const char* end_;
    std::size_t line_;
    bool obj_;
};

/// Reads all of `word` as a decimal number. Returns null, or what is wrong with it, to be put after the quoted word.
const char* read_number(std::string_view word, double& value);
const char* read_number(std::string_view word, std::int64_t& value);

/// `word` in quotes for a message: shortened, unprintable bytes as \xNN.
std::string quoted(std::string_view word);

}  // namespace xorvox::io
