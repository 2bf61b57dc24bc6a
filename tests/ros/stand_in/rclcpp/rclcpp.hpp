/* SPDX-License-Identifier: Apache-2.0 */
// A stand-in for rclcpp, for tests only, as Debian has none. It has the classes that the node uses, with their names
// and parameters. Messages go from publisher to subscription at once, in one process; qualities of service are stored
// but have no effect.
#ifndef TRIM3R_STAND_IN_RCLCPP_HPP
#define TRIM3R_STAND_IN_RCLCPP_HPP

#include <any>
#include <chrono>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace rclcpp
{

class Parameter
{
  public:
    template <class Value> Parameter(std::string name, Value value) : name_(std::move(name)), value_(std::move(value))
    {
    }
    const std::string &get_name() const
    {
        return name_;
    }
    // A parameter of another type is refused, as in rclcpp.
    template <class Value> Value get_value() const
    {
        return std::any_cast<Value>(value_);
    }

  private:
    std::string name_;
    std::any value_;
};

class NodeOptions
{
  public:
    NodeOptions &parameter_overrides(const std::vector<Parameter> &given)
    {
        overrides_ = given;
        return *this;
    }
    const std::vector<Parameter> &parameter_overrides() const
    {
        return overrides_;
    }

  private:
    std::vector<Parameter> overrides_;
};

class QoS
{
  public:
    explicit QoS(size_t depth) : depth_(depth)
    {
    }
    QoS &keep_last(size_t depth)
    {
        depth_ = depth;
        return *this;
    }
    QoS &best_effort()
    {
        reliable_ = false;
        return *this;
    }
    QoS &transient_local()
    {
        kept_ = true;
        return *this;
    }
    size_t depth() const
    {
        return depth_;
    }
    bool is_reliable() const
    {
        return reliable_;
    }
    bool is_kept() const
    {
        return kept_;
    }

  private:
    size_t depth_;
    bool reliable_ = true, kept_ = false;
};

class SensorDataQoS : public QoS
{
  public:
    SensorDataQoS() : QoS(5)
    {
        best_effort();
    }
};

class Logger
{
};
inline Logger get_logger(const std::string &)
{
    return {};
}

// Destination of log lines: stderr unless a test sets another.
inline std::function<void(const char *level, const std::string &line)> &log_sink()
{
    static std::function<void(const char *, const std::string &)> sink =
        [](const char *level, const std::string &line) { std::fprintf(stderr, "[%s] %s\n", level, line.c_str()); };
    return sink;
}

class SubscriptionBase
{
  public:
    using SharedPtr = std::shared_ptr<SubscriptionBase>;
    SubscriptionBase(std::string topic, const QoS &qos) : topic_(std::move(topic)), qos_(qos)
    {
    }
    virtual ~SubscriptionBase() = default;
    const std::string &get_topic_name() const
    {
        return topic_;
    }
    const QoS &qos() const
    {
        return qos_;
    }

  private:
    std::string topic_;
    QoS qos_;
};

template <class Message> class Subscription : public SubscriptionBase
{
  public:
    using Callback = std::function<void(const std::shared_ptr<const Message> &)>;
    Subscription(const std::string &topic, const QoS &qos, Callback callback)
        : SubscriptionBase(topic, qos), callback_(std::move(callback))
    {
    }
    void hear(const std::shared_ptr<const Message> &message) const
    {
        callback_(message);
    }

  private:
    Callback callback_;
};

// All subscriptions of the process.
inline std::vector<std::weak_ptr<SubscriptionBase>> &graph()
{
    static std::vector<std::weak_ptr<SubscriptionBase>> all;
    return all;
}

template <class Message> class Publisher
{
  public:
    using SharedPtr = std::shared_ptr<Publisher>;
    explicit Publisher(std::string topic) : topic_(std::move(topic))
    {
    }
    void publish(std::unique_ptr<Message> message)
    {
        send(std::shared_ptr<const Message>(std::move(message)));
    }
    void publish(const Message &message)
    {
        send(std::make_shared<const Message>(message));
    }

  private:
    void send(const std::shared_ptr<const Message> &message)
    {
        const auto listeners = graph(); // a callback may subscribe
        for (const auto &each : listeners) {
            const auto there = std::dynamic_pointer_cast<Subscription<Message>>(each.lock());
            if (there != nullptr && there->get_topic_name() == topic_) {
                there->hear(message);
            }
        }
    }
    std::string topic_;
};

template <class Kind> class Service
{
  public:
    using SharedPtr = std::shared_ptr<Service>;
    using Request = std::shared_ptr<typename Kind::Request>;
    using Response = std::shared_ptr<typename Kind::Response>;
    explicit Service(std::function<void(Request, Response)> answer) : answer_(std::move(answer))
    {
    }
    void call(Request request, Response response) const
    {
        answer_(std::move(request), std::move(response));
    }

  private:
    std::function<void(Request, Response)> answer_;
};

// The services of the process, by name.
inline std::map<std::string, std::any> &services()
{
    static std::map<std::string, std::any> all;
    return all;
}

class TimerBase
{
  public:
    using SharedPtr = std::shared_ptr<TimerBase>;
};

class Node
{
  public:
    explicit Node(std::string name, const NodeOptions &options = NodeOptions())
        : name_(std::move(name)), options_(options)
    {
    }
    virtual ~Node() = default;

    template <class Value> Value declare_parameter(const std::string &name, const Value &value)
    {
        for (const Parameter &given : options_.parameter_overrides()) {
            if (given.get_name() == name) {
                return given.get_value<Value>();
            }
        }
        return value;
    }
    template <class Message> auto create_publisher(const std::string &topic, const QoS &)
    {
        return std::make_shared<Publisher<Message>>(resolved(topic));
    }
    template <class Message, class Callback>
    auto create_subscription(const std::string &topic, const QoS &qos, Callback callback)
    {
        auto subscription = std::make_shared<Subscription<Message>>(resolved(topic), qos, callback);
        graph().push_back(subscription);
        return subscription;
    }
    template <class Kind, class Callback> auto create_service(const std::string &name, Callback callback)
    {
        auto service = std::make_shared<Service<Kind>>(callback);
        services()[resolved(name)] = service;
        return service;
    }
    template <class Callback> auto create_wall_timer(std::chrono::milliseconds, Callback)
    {
        return std::make_shared<TimerBase>();
    }
    Logger get_logger() const
    {
        return {};
    }

  private:
    std::string resolved(const std::string &name) const
    {
        return name[0] == '~' ? "/" + name_ + name.substr(1) : name[0] == '/' ? name : "/" + name;
    }
    std::string name_;
    NodeOptions options_;
};

inline void init(int, char **)
{
}
inline void shutdown()
{
}
inline void spin(const std::shared_ptr<Node> &)
{
}

template <class... Values> void log_line(const char *level, const char *format, const Values &...values)
{
    char line[1024];
    std::snprintf(line, sizeof line, format, values...);
    log_sink()(level, line);
}

} // namespace rclcpp

#define RCLCPP_INFO(logger, ...) ((void)(logger), rclcpp::log_line("INFO", __VA_ARGS__))
#define RCLCPP_WARN(logger, ...) ((void)(logger), rclcpp::log_line("WARN", __VA_ARGS__))
#define RCLCPP_ERROR(logger, ...) ((void)(logger), rclcpp::log_line("ERROR", __VA_ARGS__))

#endif
