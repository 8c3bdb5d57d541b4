// As much of Open Image Denoise's interface as Sheaf calls, for builds without the library. Its
// filter gives the colours times the albedo, plus the normals: a test sees what it was handed.
#ifndef SHEAF_TESTS_OIDN_STUB_OPENIMAGEDENOISE_OIDN_HPP_
#define SHEAF_TESTS_OIDN_STUB_OPENIMAGEDENOISE_OIDN_HPP_

#include <cstddef>
#include <map>
#include <memory>
#include <string>

namespace oidn {

enum class DeviceType { CPU = 1 };
enum class Format { Float3 = 3 };
enum class Error { None = 0, InvalidOperation = 3 };

struct Stub {
  std::map<std::string, float*> images;
  std::size_t floats = 0;
  bool is_hdr = false;
  int threads = 0;
  bool fails = false;
};
// Of the last device.
inline std::shared_ptr<Stub> last_stub;
inline bool next_fails = false;

class FilterRef {
 public:
  explicit FilterRef(std::shared_ptr<Stub> stub) : stub_(std::move(stub)) {}
  void setImage(const char* name, void* image, Format /*format*/, std::size_t width,
                std::size_t height) {
    stub_->images[name] = static_cast<float*>(image);
    stub_->floats = 3 * width * height;
  }
  void set(const std::string& name, bool value) {
    if (name == "hdr") stub_->is_hdr = value;
  }
  void commit() {}
  void execute() {
    for (std::size_t i = 0; i < stub_->floats && !stub_->fails; ++i) {
      const auto at = [&](const char* name, float otherwise) {
        return stub_->images.contains(name) ? stub_->images[name][i] : otherwise;
      };
      stub_->images["output"][i] = at("color", 0) * at("albedo", 1) + at("normal", 0);
    }
  }

 private:
  std::shared_ptr<Stub> stub_;
};

class DeviceRef {
 public:
  explicit DeviceRef(std::shared_ptr<Stub> stub) : stub_(std::move(stub)) {}
  void set(const std::string& name, int value) {
    if (name == "numThreads") stub_->threads = value;
  }
  void commit() {}
  FilterRef newFilter(const char* /*type*/) { return FilterRef(stub_); }
  Error getError(const char*& message) {
    message = "the stub fails";
    return stub_->fails ? Error::InvalidOperation : Error::None;
  }

 private:
  std::shared_ptr<Stub> stub_;
};

inline DeviceRef newDevice(DeviceType /*type*/) {
  last_stub = std::make_shared<Stub>();
  last_stub->fails = next_fails;
  return DeviceRef(last_stub);
}

}  // namespace oidn

#endif  // SHEAF_TESTS_OIDN_STUB_OPENIMAGEDENOISE_OIDN_HPP_
