#include "common/base/printable.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

TEST(PrintableTest, OrdinaryTextStaysAsItIs) {
  for (const char* const text :
       {"", "plain text 1.5 m", "Wärmebild 25 °C", "温度", "\xF0\x9F\x94\xA5"}) {
    EXPECT_EQ(Printable(text), text);
  }
}

TEST(PrintableTest, F65WhatATerminalObeysIsShownInstead) {
  EXPECT_EQ(Printable("\x1b]0;owned\a\x1b[2J"), "\\x1b]0;owned\\x07\\x1b[2J");
  EXPECT_EQ(Printable("a\rb\tc\x7f"), "a\\x0db\\x09c\\x7f");
  EXPECT_EQ(Printable("\xc2\x9b"
                      "31m"),
            "\\xc2\\x9b31m")
      << "the other way to write ESC [";
  EXPECT_EQ(Printable("\xe2\x80\xae"
                      "gpj"),
            "\\xe2\\x80\\xaegpj")
      << "right to left";
  EXPECT_EQ(Printable(std::string_view("a\0b", 3)), "a\\x00b");
}

TEST(PrintableTest, F65BytesThatAreNoUtf8AreShown) {
  EXPECT_EQ(Printable("\x9b"
                      "31m"),
            "\\x9b31m");
  EXPECT_EQ(Printable("\xc0\x9b"), "\\xc0\\x9b") << "longer than it must be";
  EXPECT_EQ(Printable("\xc0\xaf"), "\\xc0\\xaf") << "a slash";
  EXPECT_EQ(Printable("\xe0\x80\xaf"), "\\xe0\\x80\\xaf");
  EXPECT_EQ(Printable("\xf0\x80\x80\xaf"), "\\xf0\\x80\\x80\\xaf");
  EXPECT_EQ(Printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond the last character";
  EXPECT_EQ(Printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a pair";
  EXPECT_EQ(Printable("\xe2\x82"), "\\xe2\\x82") << "cut off";
  EXPECT_EQ(Printable("\xff"), "\\xff");
}

TEST(PrintableTest, LineBreaksStayOnlyWhereTheyAreOurs) {
  EXPECT_EQ(Printable("one\ntwo"), "one\\ntwo");
  EXPECT_EQ(PrintableLines("one\ntwo\x1b"), "one\ntwo\\x1b");
}

}  // namespace
}  // namespace isotherm
