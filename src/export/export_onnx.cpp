#include <cstring>

#include "export/export.hpp"
#include "export/source_text.hpp"
#include "thermfit/io/json/model.hpp"

/// ONNX is a protocol buffer; the few messages of a linear model are written by hand. Field numbers are those of
/// onnx.proto (IR version 8): https://github.com/onnx/onnx/blob/main/onnx/onnx.proto

namespace thermfit::cli {
namespace {

/// One protobuf message under construction.
class Message {
 public:
  Message& integer(std::uint64_t field, std::uint64_t value) { return varint(field << 3).varint(value); }
  Message& text(std::uint64_t field, std::string_view bytes) {
    varint(field << 3 | 2).varint(bytes.size());
    bytes_ += bytes;
    return *this;
  }
  Message& message(std::uint64_t field, const Message& inner) { return text(field, inner.bytes_); }
  const std::string& bytes() const { return bytes_; }

 private:
  Message& varint(std::uint64_t value) {
    for (; value >= 128; value >>= 7) bytes_ += static_cast<char>((value & 127) | 128);
    bytes_ += static_cast<char>(value);
    return *this;
  }
  std::string bytes_;
};

constexpr std::uint64_t onnx_float = 1, onnx_double = 11, ir_version = 8, opset = 13;

/// TensorProto: dims 1, data_type 2, name 8, raw_data 9 (little endian, row by row).
template <class Scalar>
Message tensor(const std::string& name, std::uint64_t type, const std::vector<Index>& shape, const Matrix& values) {
  Message message;
  for (const Index size : shape) message.integer(1, static_cast<std::uint64_t>(size));
  std::string raw;
  for (Index i = 0; i < values.rows(); ++i)
    for (Index j = 0; j < values.cols(); ++j) {
      const auto value = static_cast<Scalar>(values(i, j));
      char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      raw.append(bytes, sizeof value);
    }
  return message.integer(2, type).text(8, name).text(9, raw);
}

/// ValueInfoProto: name 1, type 2, doc 3; TypeProto.Tensor: elem_type 1, shape 2; dimension: value 1, name 2.
Message value_info(const std::string& name, std::uint64_t type, Index columns, const std::string& about) {
  Message rows, row_dimension, column_dimension, tensor_type, shape, type_message, message;
  row_dimension.text(2, "rows");
  column_dimension.integer(1, static_cast<std::uint64_t>(columns));
  shape.message(1, row_dimension).message(1, column_dimension);
  tensor_type.integer(1, type).message(2, shape);
  type_message.message(1, tensor_type);
  return message.text(1, name).message(2, type_message).text(3, about);
}

/// NodeProto: input 1, output 2, name 3, op_type 4.
Message node(const std::string& operation, const std::string& a, const std::string& b, const std::string& result) {
  Message message;
  return message.text(1, a).text(1, b).text(2, result).text(3, operation).text(4, operation);
}

}  // namespace

ControllerSource export_onnx(const ExportRequest& request) {
  const TrainedModel& model = request.trained;
  require_formula(request, "onnx", "ONNX holds a formula of one sample");
  const double factor = static_cast<double>(static_cast<int>(request.wishes.sign)) * request.unit.per_um;
  const Matrix coefficients = model.model.coefficients * factor;
  const Matrix intercept = model.model.intercept.transpose() * factor;
  const Index sensors = model.model.sensors(), errors = model.model.errors();
  const std::uint64_t type = request.single_precision ? onnx_float : onnx_double;
  const auto write_tensor = request.single_precision ? tensor<float> : tensor<double>;
  const std::string input = model.reference == TemperatureReference::rise ? "temperature_rise_K" : "temperature_degC";
  const std::string output = sign_name(request.wishes.sign) + "_" + request.unit.identifier;
  std::string points, axes;
  for (const std::string& name : model.temperatures) points += (points.empty() ? "" : ",") + name;
  for (const std::string& name : model.errors) axes += (axes.empty() ? "" : ",") + name;

  Message graph;  // GraphProto: node 1, name 2, initializer 5, input 11, output 12
  graph.message(1, node("MatMul", input, "coefficients", "product"))
      .message(1, node("Add", "product", "intercept", output))
      .text(2, request.name)
      .message(5, write_tensor("coefficients", type, {sensors, errors}, coefficients))
      .message(5, write_tensor("intercept", type, {errors}, intercept))
      .message(11, value_info(input, type, sensors, points))
      .message(12, value_info(output, type, errors, axes));

  std::string about;
  for (const std::string& line : facts(request)) about += line + '\n';
  about += "This is the bare model: no check of sensors, no clamp, no slew limit; NaN in gives NaN out.\n";
  Message document, opset_message;
  opset_message.text(1, "").integer(2, opset);
  // ModelProto: ir_version 1, producer 2 and 3, doc 6, graph 7, opset 8, metadata 14
  document.integer(1, ir_version).text(2, "thermfit").text(3, THERMFIT_VERSION).text(6, about).message(7, graph);
  document.message(8, opset_message);
  const std::pair<std::string, std::string> metadata[] = {
      {"temperatures", points},
      {"errors", axes},
      {"unit", request.unit.name},
      {"sign", sign_name(request.wishes.sign)},
      {"digest", model_to_json(model)["digest"].get<std::string>()}};
  for (const auto& [key, value] : metadata) {
    Message entry;
    document.message(14, entry.text(1, key).text(2, value));
  }
  return document.bytes();
}

}  // namespace thermfit::cli
