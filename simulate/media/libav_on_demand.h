// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// libav's functions, loaded when the first of them is called. With the 130 libraries that libav
// needs in turn, loading it with the program takes two thirds of the program's start, and few
// commands read or write pictures. In this namespace the names below stand before libav's own.

#ifndef FLOCKLIFT_SIMULATE_MEDIA_LIBAV_ON_DEMAND_H_
#define FLOCKLIFT_SIMULATE_MEDIA_LIBAV_ON_DEMAND_H_

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <atomic>

namespace flocklift {
namespace internal {

// The address of a function of libav. Throws std::runtime_error when libav is not installed in the
// version that the program was built with. Any thread may call.
void* FindInLibav(const char* name);

template <typename Function>
class OnDemand;
template <typename R, typename... A>
class OnDemand<R(A...)> {
 public:
  constexpr explicit OnDemand(const char* name) : name_(name) {}
  R operator()(A... arguments) const {
    void* function = found_.load(std::memory_order_acquire);
    if (function == nullptr) {
      function = FindInLibav(name_);
      found_.store(function, std::memory_order_release);
    }
    return reinterpret_cast<R (*)(A...)>(function)(arguments...);
  }

 private:
  const char* name_;
  mutable std::atomic<void*> found_ = nullptr;
};

}  // namespace internal

// What is said of a function (that its result matters, say) is no part of its type.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"
#define FLOCKLIFT_ON_DEMAND(name) \
  inline constinit const internal::OnDemand<decltype(::name)> name(#name);
FLOCKLIFT_ON_DEMAND(av_d2q)
FLOCKLIFT_ON_DEMAND(av_dict_free)
FLOCKLIFT_ON_DEMAND(av_dict_get)
FLOCKLIFT_ON_DEMAND(av_dict_set)
FLOCKLIFT_ON_DEMAND(av_display_rotation_get)
FLOCKLIFT_ON_DEMAND(av_find_best_stream)
FLOCKLIFT_ON_DEMAND(av_frame_alloc)
FLOCKLIFT_ON_DEMAND(av_frame_free)
FLOCKLIFT_ON_DEMAND(av_frame_get_buffer)
FLOCKLIFT_ON_DEMAND(av_frame_make_writable)
FLOCKLIFT_ON_DEMAND(av_guess_frame_rate)
FLOCKLIFT_ON_DEMAND(av_interleaved_write_frame)
FLOCKLIFT_ON_DEMAND(av_log_set_level)
FLOCKLIFT_ON_DEMAND(av_new_packet)
FLOCKLIFT_ON_DEMAND(av_opt_set)
FLOCKLIFT_ON_DEMAND(av_opt_set_int)
FLOCKLIFT_ON_DEMAND(av_packet_alloc)
FLOCKLIFT_ON_DEMAND(av_packet_free)
FLOCKLIFT_ON_DEMAND(av_packet_rescale_ts)
FLOCKLIFT_ON_DEMAND(av_packet_unref)
FLOCKLIFT_ON_DEMAND(av_read_frame)
FLOCKLIFT_ON_DEMAND(av_seek_frame)
FLOCKLIFT_ON_DEMAND(av_stream_get_side_data)
FLOCKLIFT_ON_DEMAND(av_strerror)
FLOCKLIFT_ON_DEMAND(av_write_trailer)
FLOCKLIFT_ON_DEMAND(avcodec_alloc_context3)
FLOCKLIFT_ON_DEMAND(avcodec_find_decoder)
FLOCKLIFT_ON_DEMAND(avcodec_find_encoder)
FLOCKLIFT_ON_DEMAND(avcodec_find_encoder_by_name)
FLOCKLIFT_ON_DEMAND(avcodec_flush_buffers)
FLOCKLIFT_ON_DEMAND(avcodec_free_context)
FLOCKLIFT_ON_DEMAND(avcodec_open2)
FLOCKLIFT_ON_DEMAND(avcodec_parameters_from_context)
FLOCKLIFT_ON_DEMAND(avcodec_parameters_to_context)
FLOCKLIFT_ON_DEMAND(avcodec_receive_frame)
FLOCKLIFT_ON_DEMAND(avcodec_receive_packet)
FLOCKLIFT_ON_DEMAND(avcodec_send_frame)
FLOCKLIFT_ON_DEMAND(avcodec_send_packet)
FLOCKLIFT_ON_DEMAND(avformat_alloc_output_context2)
FLOCKLIFT_ON_DEMAND(avformat_close_input)
FLOCKLIFT_ON_DEMAND(avformat_find_stream_info)
FLOCKLIFT_ON_DEMAND(avformat_free_context)
FLOCKLIFT_ON_DEMAND(avformat_new_stream)
FLOCKLIFT_ON_DEMAND(avformat_open_input)
FLOCKLIFT_ON_DEMAND(avformat_write_header)
FLOCKLIFT_ON_DEMAND(avio_closep)
FLOCKLIFT_ON_DEMAND(avio_open)
FLOCKLIFT_ON_DEMAND(sws_freeContext)
FLOCKLIFT_ON_DEMAND(sws_getCachedContext)
FLOCKLIFT_ON_DEMAND(sws_getCoefficients)
FLOCKLIFT_ON_DEMAND(sws_getContext)
FLOCKLIFT_ON_DEMAND(sws_scale)
FLOCKLIFT_ON_DEMAND(sws_setColorspaceDetails)
#undef FLOCKLIFT_ON_DEMAND
#pragma GCC diagnostic pop

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_MEDIA_LIBAV_ON_DEMAND_H_
