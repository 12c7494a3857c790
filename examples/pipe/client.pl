#!/usr/bin/perl
# Runs a gas of needles through a pipe to `needlework serve`, without any binding: only JSON.
#   client.pl NEEDLEWORK
use strict;
use warnings;
use IPC::Open2;
use JSON::PP;
use MIME::Base64;

my $server = open2(my $answers, my $requests, shift // "needlework", "serve");

sub ask {
    my (%request) = @_;
    print $requests encode_json(\%request), "\n";    # open2 flushes after each line
    my $answer = decode_json(scalar readline $answers);
    die "$answer->{message}\n" unless $answer->{ok};
    return $answer;
}

my $scene = <<'TOML';
[needles]
count = 1000
box = 11
[collisions]
epsilon = 0.9
tc_relative = 1e-3
TOML

my $gas = ask(do => "create", scene => $scene)->{simulation};
for (1 .. 5) {
    my $now = ask(do => "advance", simulation => $gas, collisions => 2000);
    printf "time %.3f: %d collisions, energy %.4f\n", @$now{qw(time collisions energy)};
}

# Arrays come as bytes in base64: three doubles for each needle.
my $state = ask(do => "state", simulation => $gas);
my @x = unpack "d<*", decode_base64($state->{position});
printf "needle 0 is at %.4f %.4f %.4f\n", @x[0 .. 2];
print "hash ", ask(do => "totals", simulation => $gas)->{trajectory_hash}, "\n";
ask(do => "quit");
waitpid $server, 0;
