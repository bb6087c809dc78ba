#include "common/recording/schema.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <set>

namespace isotherm::recording {
namespace {

void AddFileWithImports(const google::protobuf::FileDescriptor& file, std::set<std::string>& done,
                        google::protobuf::FileDescriptorSet& files) {
  if (!done.insert(file.name()).second) return;
  for (int i = 0; i < file.dependency_count(); ++i) {
    AddFileWithImports(*file.dependency(i), done, files);
  }
  file.CopyTo(files.add_file());
}

}  // namespace

std::string SerializedSchema(const google::protobuf::Descriptor& descriptor) {
  google::protobuf::FileDescriptorSet files;
  std::set<std::string> done;
  AddFileWithImports(*descriptor.file(), done, files);
  return files.SerializeAsString();
}

}  // namespace isotherm::recording
