#pragma once

#include <string>

namespace isolux {

/// Opens /dev/null in the place of standard streams that the caller closed: a file opened later would take their number
/// and get our messages. What is written to standard output then fails: a script that asks for it is told that it is
/// lost.
void open_standard_streams();

/// Text for people, on stderr. One that is gone or full is no reason to lose work: nothing is thrown.
void tell(const std::string& text);

/// One line on stderr, `isolux: error: WHAT: WHY`; control characters, such as a broken file's, become blanks.
void complain(const std::string& what, std::string why);

/// One line on stderr, `isolux: warning: WHAT`, likewise.
void warn(std::string what);

/// Text for programs, on standard output; flush_output() says whether it got there. \throw IoError if it is known
/// already
void put_out(const std::string& text);

/// \throw IoError if what was printed has not all reached standard output.
void flush_output();

}  // namespace isolux
