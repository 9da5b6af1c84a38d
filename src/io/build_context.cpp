#include "src/io/build_context.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/io/nearest_name.h"

namespace dapple {

void WarnUnsupported(const BuildContext& context, const ParameterList& params, std::string_view name) {
  if (const Parameter* parameter = params.Find(name))
    context.diagnostics.Warn(parameter->location, fmt::format("parameter \"{}\" is not supported and ignored", name));
}

void FailUnknownName(const FileLocation& location, std::string_view what, std::string_view name,
                     const std::vector<std::string>& known) {
  throw Error(location, fmt::format("unknown {} \"{}\", expected one of {}{}", what, name, fmt::join(known, ", "),
                                    DidYouMean(name, known)));
}

}  // namespace dapple
