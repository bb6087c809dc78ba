#include "common/base/escape_html.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

TEST(EscapeHtml, LeavesNothingThatOpensATagAnEntityOrAnAttribute) {
  EXPECT_EQ(EscapeHtml(R"(<a href="x">T & U</a>)"),
            "&lt;a href=&quot;x&quot;&gt;T &amp; U&lt;/a&gt;");
  EXPECT_EQ(EscapeHtml("41,5 °C"), "41,5 °C");
}

}  // namespace
}  // namespace isotherm
